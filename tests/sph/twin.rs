//! Twin of a δ-SPH step in f64 and SI units over all pairs: Wendland C2; momentum with artificial viscosity from the old
//! state, continuity with diffusion and displacement with the new velocity; boundary particles with extrapolated pressure,
//! and the penalty force of bodies.

use glam::{DMat3, DVec3};
use riprap::{
    geometry::{HalfSpace, Pose},
    sph::{EquationOfState, Setup, Side, Solid},
};
use std::f64::consts::PI;

#[derive(Clone, Copy, Debug)]
pub struct FluidParticle {
    pub x: DVec3,
    pub v: DVec3,
    pub rho: f64,
}

#[derive(Clone, Copy, Debug)]
pub struct BoundaryParticle {
    pub x: DVec3,
    pub v: DVec3,
    /// Acceleration of the wall.
    pub a: DVec3,
    pub free_slip: bool,
}

pub struct Outcome {
    pub water: Vec<FluidParticle>,
    /// Force on each boundary particle.
    pub forces: Vec<DVec3>,
    /// Longest next step.
    pub step_limit: f64,
    /// Work of boundary particles beyond that of their bodies.
    pub boundary_work: f64,
    /// Work of the penalty force.
    pub penalty_work: f64,
}

/// The setup and the poses of the bodies.
pub struct Twin<'a>(pub &'a Setup, pub &'a [Pose]);

impl Twin<'_> {
    fn h(&self) -> f64 {
        self.0.smoothing * self.0.spacing
    }

    /// Normalisation of the kernel; in a plane per width.
    fn alpha(&self) -> f64 {
        let h = self.h();
        if self.0.plane {
            7.0 / (4.0 * PI * h * h)
        } else {
            21.0 / (16.0 * PI * h * h * h)
        }
    }

    pub fn w(&self, r: f64) -> f64 {
        let q = r / self.h();
        if q >= 2.0 {
            0.0
        } else {
            self.alpha() * (1.0 - q / 2.0).powi(4) * (1.0 + 2.0 * q)
        }
    }

    /// ∇W at the end of r.
    fn gradient(&self, r: DVec3) -> DVec3 {
        let (d, h) = (r.length(), self.h());
        let q = d / h;
        if q >= 2.0 || d == 0.0 {
            return DVec3::ZERO;
        }
        let slope = self.alpha() / h
            * (-2.0 * (1.0 - q / 2.0).powi(3) * (1.0 + 2.0 * q) + 2.0 * (1.0 - q / 2.0).powi(4));
        slope * r / d
    }

    /// From the nearest image of b to a.
    fn separation(&self, a: DVec3, b: DVec3) -> DVec3 {
        let mut r = a - b;
        for axis in 0..3 {
            if self.0.faces[axis][0] == Side::Periodic && !(self.0.plane && axis == 1) {
                r[axis] -= self.0.size[axis] * (r[axis] / self.0.size[axis]).round();
            }
        }
        r
    }

    fn pressure(&self, rho: f64) -> f64 {
        let c2 = self.0.sound_speed.powi(2);
        match self.0.equation_of_state {
            EquationOfState::Linear => c2 * (rho - self.0.density),
            EquationOfState::Tait => {
                self.0.density * c2 / 7.0 * ((rho / self.0.density).powi(7) - 1.0)
            }
        }
    }

    fn density(&self, p: f64) -> f64 {
        let c2 = self.0.sound_speed.powi(2);
        match self.0.equation_of_state {
            EquationOfState::Linear => self.0.density + p / c2,
            EquationOfState::Tait => {
                self.0.density * (1.0 + 7.0 * p / (self.0.density * c2)).powf(1.0 / 7.0)
            }
        }
    }

    /// Mass, per width in a plane.
    fn mass(&self) -> f64 {
        self.0.density * self.0.spacing.powi(if self.0.plane { 2 } else { 3 })
    }

    pub fn wall_pressure(&self, water: &[FluidParticle], wall: &BoundaryParticle) -> f64 {
        let (mut above, mut below) = (0.0, 0.0);
        for f in water {
            let r = self.separation(wall.x, f.x);
            let w = self.w(r.length());
            above += w * (self.pressure(f.rho) + f.rho * (self.0.gravity - wall.a).dot(r));
            below += w;
        }
        if below > 0.0 {
            (above / below).max(0.0)
        } else {
            0.0
        }
    }

    /// Fraction of the kernel around a point that water covers.
    pub fn water_fraction(&self, water: &[FluidParticle], x: DVec3) -> f64 {
        let cell = self.0.spacing.powi(if self.0.plane { 2 } else { 3 });
        let weights = water
            .iter()
            .map(|f| self.w(self.separation(x, f.x).length()));
        cell * weights.sum::<f64>()
    }

    /// Velocity of a boundary particle for no slip: the velocity of the water extrapolated about that of the wall.
    fn wall_velocity(&self, water: &[FluidParticle], wall: &BoundaryParticle) -> DVec3 {
        let (mut above, mut below) = (DVec3::ZERO, 0.0);
        for f in water {
            let w = self.w(self.separation(wall.x, f.x).length());
            above += w * f.v;
            below += w;
        }
        if below > 0.0 {
            2.0 * wall.v - above / below
        } else {
            wall.v
        }
    }

    /// Viscous acceleration at the densities `[a, b]`, the separation `r` and the relative velocity `v`.
    fn viscous(&self, [a, b]: [f64; 2], r: DVec3, v: DVec3) -> DVec3 {
        if r.length() == 0.0 {
            return DVec3::ZERO;
        }
        // μ = ρ₀ ν of both.
        let both = 2.0 * self.0.density * self.0.laminar_viscosity;
        self.mass() * both / (a * b) * r.dot(self.gradient(r)) / r.length_squared() * v
    }

    /// Penalty acceleration by fixed bodies; zero if no boundary particle is near.
    fn penalty(&self, at: &FluidParticle, walls: &[BoundaryParticle]) -> DVec3 {
        let rate = self.0.sound_speed / self.0.spacing;
        let spring = Spring {
            stiffness: (0.1 * rate).powi(2),
            damping: 0.5 * rate,
        };
        let near = 0.95 * self.0.spacing;
        if walls
            .iter()
            .all(|wall| self.separation(at.x, wall.x).length() >= near)
        {
            return DVec3::ZERO;
        }
        let fixed = self.1.iter().zip(&self.0.bodies).filter(|(_, b)| !b.moves);
        let accelerations = fixed.flat_map(|(pose, body)| {
            let solids = body.solids.iter();
            solids.map(|solid| penalty(spring, pose, solid, at.x, at.v))
        });
        accelerations.sum()
    }

    pub fn step(&self, water: &[FluidParticle], walls: &[BoundaryParticle], dt: f64) -> Outcome {
        let (m, h, c) = (self.mass(), self.h(), self.0.sound_speed);
        let pressures: Vec<f64> = walls.iter().map(|w| self.wall_pressure(water, w)).collect();
        let velocities: Vec<DVec3> = walls.iter().map(|w| self.wall_velocity(water, w)).collect();
        let mut forces = vec![DVec3::ZERO; walls.len()];
        let (mut new_velocities, mut step_limit) = (Vec::new(), f64::INFINITY);
        let (mut boundary_work, mut penalty_work) = (0.0, 0.0);
        for i in water {
            let (mut a, mut steepest) = (self.0.gravity, 0.0f64);
            let mut excess = Vec::new();
            for j in water {
                let r = self.separation(i.x, j.x);
                if r.length() >= 2.0 * h {
                    continue;
                }
                let vr = (i.v - j.v).dot(r);
                let mu = h * vr / (r.length_squared() + 0.01 * h * h);
                steepest = steepest.max(mu.abs());
                let pi = if vr < 0.0 {
                    -self.0.artificial_viscosity * c * mu / (0.5 * (i.rho + j.rho))
                } else {
                    0.0
                };
                let push = (self.pressure(i.rho) + self.pressure(j.rho)) / (i.rho * j.rho) + pi;
                a -= m * push * self.gradient(r);
                a += self.viscous([i.rho, j.rho], r, i.v - j.v);
            }
            for (k, w) in walls.iter().enumerate() {
                let rho = self.density(pressures[k]);
                let push = (self.pressure(i.rho) + pressures[k]) / (i.rho * rho);
                let r = self.separation(i.x, w.x);
                // Kinetic energy by the push, less the compression energy at walls of the reference density.
                let beyond = push - self.pressure(i.rho) / (i.rho * self.0.density);
                excess.push((w.v, m * m * beyond * self.gradient(r)));
                let mut pull = m * push * self.gradient(r);
                if !w.free_slip {
                    pull -= self.viscous([i.rho, rho], r, i.v - velocities[k]);
                }
                a -= pull;
                forces[k] += m * pull;
            }
            let v = i.v + a * dt;
            let by_force = (h / a.length()).sqrt();
            let by_sound = h / (c.max(10.0 * v.length()) + steepest);
            let by_viscosity = h * h / (8.0 * self.0.laminar_viscosity);
            let by_courant = self.0.courant * by_force.min(by_sound);
            step_limit = step_limit.min(by_courant.min(by_viscosity));
            let middle = 0.5 * (i.v + v);
            let works = excess.iter().map(|(wall, f)| -dt * f.dot(middle - *wall));
            boundary_work += works.sum::<f64>();
            let repulsion = self.penalty(i, walls);
            let end = v + repulsion * dt;
            penalty_work += dt * m * repulsion.dot(0.5 * (i.v + end));
            new_velocities.push(end);
        }
        let mut out = Vec::new();
        for (n, i) in water.iter().enumerate() {
            let mut rate = 0.0;
            for (k, j) in water.iter().enumerate() {
                let r = self.separation(i.x, j.x);
                let (volume, gradient) = (m / j.rho, self.gradient(r));
                rate += i.rho * volume * (new_velocities[n] - new_velocities[k]).dot(gradient);
                if r.length() > 0.0 {
                    // Hydrostatic density difference of j to i.
                    let hydrostatic = -self.0.density * self.0.gravity.dot(r) / (c * c);
                    let excess = j.rho - i.rho - hydrostatic;
                    let flux = 2.0 * excess * (-r).dot(gradient) / r.length_squared();
                    rate += self.0.density_diffusion * h * c * volume * flux;
                }
            }
            for w in walls {
                let gradient = self.gradient(self.separation(i.x, w.x));
                let volume = m / self.0.density;
                rate += i.rho * volume * (new_velocities[n] - w.v).dot(gradient);
            }
            out.push(FluidParticle {
                x: i.x + new_velocities[n] * dt,
                v: new_velocities[n],
                rho: i.rho + rate * dt,
            });
        }
        Outcome {
            water: out,
            forces,
            step_limit,
            boundary_work,
            penalty_work,
        }
    }
}

/// Force and Σ f ⊗ r of forces with lever arms.
pub fn wrench(forces: &[DVec3], levers: &[DVec3]) -> (DVec3, DMat3) {
    let mut moment = DMat3::ZERO;
    for (f, r) in forces.iter().zip(levers) {
        moment += DMat3::from_cols(*f * r.x, *f * r.y, *f * r.z);
    }
    (forces.iter().copied().sum(), moment)
}

/// A spring and a damper per unit of mass.
#[derive(Clone, Copy)]
pub struct Spring {
    /// 1/s².
    pub stiffness: f64,
    /// 1/s.
    pub damping: f64,
}

/// Acceleration of water at `x` (m) with the velocity `v` (m/s) by the penalty force of a convex part of the body at `pose`,
/// eq. 22 of Geraili Mikola & Sitar (2014).
pub fn penalty(spring: Spring, pose: &Pose, solid: &Solid, x: DVec3, v: DVec3) -> DVec3 {
    let reference = pose.deformation.transpose() * (x - pose.centre);
    let depth = |face: &HalfSpace| face.distance - face.normal.dot(reference);
    let (depth, normal) = match solid {
        Solid::Sphere { centre, radius } => {
            let from = reference - *centre;
            (radius - from.length(), from.normalize())
        }
        Solid::Faces(faces) => {
            if faces.internal.iter().any(|face| depth(face) < 0.0) {
                return DVec3::ZERO;
            }
            let nearest = faces.exposed.iter();
            let nearest = nearest.min_by(|a, b| depth(a).total_cmp(&depth(b)));
            let Some(face) = nearest else {
                return DVec3::ZERO;
            };
            (depth(face), face.normal)
        }
    };
    if depth <= 0.0 {
        return DVec3::ZERO;
    }
    let n = pose.deformation * normal;
    let approach = (v - pose.point_velocity(reference)).dot(n);
    (spring.stiffness * depth - spring.damping * approach).max(0.0) * n
}
