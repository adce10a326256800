//! A step of the scheme in f64 and SI units, each particle with each other: Wendland C2; momentum with artificial
//! viscosity from the old state, continuity with diffusion and the way with the new velocity; dummy particles with
//! the pressure of the water before them, and the push of bodies on what is in them.

use crate::push::{Spring, push};
use glam::{DMat3, DVec3};
use riprap::{
    bodies::Pose,
    particles::{Setup, Side, StateEquation},
};
use std::f64::consts::PI;

#[derive(Clone, Copy, Debug)]
pub struct Wet {
    pub x: DVec3,
    pub v: DVec3,
    pub rho: f64,
}

#[derive(Clone, Copy, Debug)]
pub struct Dummy {
    pub x: DVec3,
    pub v: DVec3,
    /// Acceleration of the wall.
    pub a: DVec3,
    pub slips: bool,
}

pub struct Outcome {
    pub water: Vec<Wet>,
    /// Force on each dummy particle.
    pub forces: Vec<DVec3>,
    /// Longest next step.
    pub limit: f64,
    /// Work of dummy particles beyond that of their bodies.
    pub pressed: f64,
    /// Work of the push of bodies.
    pub pushed: f64,
}

/// The water's constants, and where the bodies are.
pub struct Twin<'a>(pub &'a Setup, pub &'a [Pose]);

impl Twin<'_> {
    fn h(&self) -> f64 {
        self.0.smoothing * self.0.spacing
    }

    /// Normalisation in a plane per width.
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
    fn between(&self, a: DVec3, b: DVec3) -> DVec3 {
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
        match self.0.state {
            StateEquation::Linear => c2 * (rho - self.0.density),
            StateEquation::Tait => {
                self.0.density * c2 / 7.0 * ((rho / self.0.density).powi(7) - 1.0)
            }
        }
    }

    fn density(&self, p: f64) -> f64 {
        let c2 = self.0.sound_speed.powi(2);
        match self.0.state {
            StateEquation::Linear => self.0.density + p / c2,
            StateEquation::Tait => {
                self.0.density * (1.0 + 7.0 * p / (self.0.density * c2)).powf(1.0 / 7.0)
            }
        }
    }

    /// Mass, per width in a plane.
    fn mass(&self) -> f64 {
        self.0.density * self.0.spacing.powi(if self.0.plane { 2 } else { 3 })
    }

    pub fn wall_pressure(&self, water: &[Wet], wall: &Dummy) -> f64 {
        let (mut above, mut below) = (0.0, 0.0);
        for f in water {
            let r = self.between(wall.x, f.x);
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

    /// Share of the kernel around a place that water covers.
    pub fn covered(&self, water: &[Wet], x: DVec3) -> f64 {
        let cell = self.0.spacing.powi(if self.0.plane { 2 } else { 3 });
        let weights = water.iter().map(|f| self.w(self.between(x, f.x).length()));
        cell * weights.sum::<f64>()
    }

    /// The velocity of the water before a wall, continued into it about the wall's own.
    fn wall_velocity(&self, water: &[Wet], wall: &Dummy) -> DVec3 {
        let (mut above, mut below) = (DVec3::ZERO, 0.0);
        for f in water {
            let w = self.w(self.between(wall.x, f.x).length());
            above += w * f.v;
            below += w;
        }
        if below > 0.0 {
            2.0 * wall.v - above / below
        } else {
            wall.v
        }
    }

    /// What friction of a neighbour at `r` adds to the rate of a velocity that differs from its by `v`.
    fn friction(&self, [a, b]: [f64; 2], r: DVec3, v: DVec3) -> DVec3 {
        if r.length() == 0.0 {
            return DVec3::ZERO;
        }
        // μ = ρ₀ ν of both.
        let both = 2.0 * self.0.density * self.0.laminar_viscosity;
        self.mass() * both / (a * b) * r.dot(self.gradient(r)) / r.length_squared() * v
    }

    /// What bodies that do not move do to water that is in them: nothing if no dummy particle is near.
    fn kept_out(&self, at: &Wet, walls: &[Dummy]) -> DVec3 {
        let rate = self.0.sound_speed / self.0.spacing;
        let spring = Spring {
            stiffness: (0.1 * rate).powi(2),
            damping: 0.5 * rate,
        };
        let near = 0.95 * self.0.spacing;
        if walls
            .iter()
            .all(|wall| self.between(at.x, wall.x).length() >= near)
        {
            return DVec3::ZERO;
        }
        let still = self.1.iter().zip(&self.0.bodies).filter(|(_, b)| !b.moves);
        let pushes = still.flat_map(|(pose, body)| {
            let solids = body.solids.iter();
            solids.map(|solid| push(spring, pose, solid, at.x, at.v))
        });
        pushes.sum()
    }

    pub fn step(&self, water: &[Wet], walls: &[Dummy], dt: f64) -> Outcome {
        let (m, h, c) = (self.mass(), self.h(), self.0.sound_speed);
        let pressures: Vec<f64> = walls.iter().map(|w| self.wall_pressure(water, w)).collect();
        let velocities: Vec<DVec3> = walls.iter().map(|w| self.wall_velocity(water, w)).collect();
        let mut forces = vec![DVec3::ZERO; walls.len()];
        let (mut fresh, mut limit) = (Vec::new(), f64::INFINITY);
        let (mut pressed, mut pushed) = (0.0, 0.0);
        for i in water {
            let (mut a, mut steepest) = (self.0.gravity, 0.0f64);
            let mut beside = Vec::new();
            for j in water {
                let r = self.between(i.x, j.x);
                if r.length() >= 2.0 * h {
                    continue;
                }
                let vr = (i.v - j.v).dot(r);
                let mu = h * vr / (r.length_squared() + 0.01 * h * h);
                steepest = steepest.max(mu.abs());
                let pi = match vr < 0.0 {
                    true => -self.0.artificial_viscosity * c * mu / (0.5 * (i.rho + j.rho)),
                    false => 0.0,
                };
                let push = (self.pressure(i.rho) + self.pressure(j.rho)) / (i.rho * j.rho) + pi;
                a -= m * push * self.gradient(r);
                a += self.friction([i.rho, j.rho], r, i.v - j.v);
            }
            for (k, w) in walls.iter().enumerate() {
                let rho = self.density(pressures[k]);
                let push = (self.pressure(i.rho) + pressures[k]) / (i.rho * rho);
                let r = self.between(i.x, w.x);
                // Kinetic energy by the push, less what compresses: that is of walls of the reference density.
                let beyond = push - self.pressure(i.rho) / (i.rho * self.0.density);
                beside.push((w.v, m * m * beyond * self.gradient(r)));
                let mut pull = m * push * self.gradient(r);
                if !w.slips {
                    pull -= self.friction([i.rho, rho], r, i.v - velocities[k]);
                }
                a -= pull;
                forces[k] += m * pull;
            }
            let v = i.v + a * dt;
            let by_force = (h / a.length()).sqrt();
            let by_sound = h / (c.max(10.0 * v.length()) + steepest);
            let by_friction = h * h / (8.0 * self.0.laminar_viscosity);
            limit = limit.min((self.0.courant * by_force.min(by_sound)).min(by_friction));
            let middle = 0.5 * (i.v + v);
            let works = beside.iter().map(|(wall, f)| -dt * f.dot(middle - *wall));
            pressed += works.sum::<f64>();
            let kept = self.kept_out(i, walls);
            let end = v + kept * dt;
            pushed += dt * m * kept.dot(0.5 * (i.v + end));
            fresh.push(end);
        }
        let mut out = Vec::new();
        for (n, i) in water.iter().enumerate() {
            let mut rate = 0.0;
            for (k, j) in water.iter().enumerate() {
                let r = self.between(i.x, j.x);
                let (volume, gradient) = (m / j.rho, self.gradient(r));
                rate += i.rho * volume * (fresh[n] - fresh[k]).dot(gradient);
                if r.length() > 0.0 {
                    // What the density of still water at j has more than at i.
                    let still = -self.0.density * self.0.gravity.dot(r) / (c * c);
                    let excess = j.rho - i.rho - still;
                    let flux = 2.0 * excess * (-r).dot(gradient) / r.length_squared();
                    rate += self.0.density_diffusion * h * c * volume * flux;
                }
            }
            for w in walls {
                let gradient = self.gradient(self.between(i.x, w.x));
                let volume = m / self.0.density;
                rate += i.rho * volume * (fresh[n] - w.v).dot(gradient);
            }
            out.push(Wet {
                x: i.x + fresh[n] * dt,
                v: fresh[n],
                rho: i.rho + rate * dt,
            });
        }
        Outcome {
            water: out,
            forces,
            limit,
            pressed,
            pushed,
        }
    }
}

/// Force and Σ f ⊗ r of forces at places.
pub fn wrench(forces: &[DVec3], levers: &[DVec3]) -> (DVec3, DMat3) {
    let mut moment = DMat3::ZERO;
    for (f, r) in forces.iter().zip(levers) {
        moment += DMat3::from_cols(*f * r.x, *f * r.y, *f * r.z);
    }
    (forces.iter().copied().sum(), moment)
}
