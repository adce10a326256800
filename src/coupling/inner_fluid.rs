//! The fluid inside a block, and the fluid around it that has inertia too.

use super::{Felt, loads::sum};
use crate::bodies::{Load, Pose, skew};
use crate::immersed::spin;
use crate::integrate::Principal;
use glam::{DMat3, DVec3};

/// The most of the fluid outside that a block has to move, over what it displaces: its mass, and its inertia for turns.
///
/// By the edges a ≤ b ≤ c of the box that has its inertia: ⅔ √(bc)/a bounds the added mass of potential flow, which is half
/// for a sphere, two thirds for a cube, and 0.48 √(bc)/a for a thin disc (Lamb 1932, art. 102); half of √(bc)/a that
/// of turns. A viscous layer that goes along makes the box grow by itself on each side, to G times the volume: that is
/// G − 1 of the mass, and G times of what is moved around; for turns 1.5 (G^(5/3) − 1). A larger bound than is needed slows the answer to sound, which then
/// drives a light block between walls: on a cube of eight cells that is 2.3 and 3.6, with half the density of the fluid,
/// 5 and 10 were unstable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Around {
    /// Of translations.
    pub mass: f64,
    /// Of turns.
    pub inertia: f64,
}

impl Around {
    /// Of a block of this volume (m³) and tensor of inertia for a density of one (m⁵) in a viscous layer (m) that is as
    /// thick as a cell, or the way of viscosity in the time between two exchanges.
    pub fn of(volume: f64, inertia: DMat3, layer: f64) -> Self {
        let moments = Principal::of(inertia).moments;
        // Of a box, I_x = V (b² + c²)/12.
        let squares = (0.5 * moments.element_sum() - moments) * (12.0 / volume);
        let mut edges = squares.to_array().map(|square| square.max(0.0).sqrt());
        edges.sort_by(f64::total_cmp);
        let [a, b, c] = edges;
        let [p, q, r] = edges.map(|edge| edge + 2.0 * layer);
        let grown = p * q * r / (a * b * c);
        let flat = (q * r).sqrt() / p;
        Self {
            mass: grown - 1.0 + 2.0 / 3.0 * flat * grown,
            inertia: 1.5 * (grown.powf(5.0 / 3.0) - 1.0) + 0.5 * flat,
        }
    }
}

/// What a block is made of.
#[derive(Clone, Copy, Debug)]
pub struct Matter {
    /// kg.
    pub mass: f64,
    /// m³.
    pub volume: f64,
    /// Tensor of inertia for a density of one, world, m⁵.
    pub inertia: DMat3,
    /// Gravity, m/s².
    pub gravity: DVec3,
    /// The fluid around it.
    pub around: Around,
}

/// The fluid inside a block goes where the block goes: the block feels its inertia through the cells, and gets
/// it back from here, m_f dv/dt of the last exchange with m_f = ρ Σε, since its mass stands for the rock alone.
/// Not ρ ΣB: the fluid in cells at the surface follows too, only later, and at low viscosity B is small there. What
/// a block gets back before the fluid has followed drives it on, and a light one ever faster: m_f is at most
/// ρ ΣB + m/2, and for turns, where cells at the surface weigh most, (ρ ΣB + m)/2. Rock has that to spare.
///
/// The loads answer to what the block did in the last step. Fluid that has to make way, the added mass m_a, then
/// makes a block that is lighter than it swing ever more. So the block moves as if it had the mass m_v more, and
/// gets m_v times its last acceleration (Schwarz, Kempe & Fröhlich 2015, J. Comput. Phys. 281:591):
/// (m + m_v) a = F + m_f dv/dt + m g + m_v a_before. That is stable for m_a < m + 2 m_v, from which m_v follows, and
/// changes nothing once the acceleration is steady. Contacts are not in a: they act on the rock alone.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InnerFluid {
    /// Velocity and spin at the last exchange, m/s and rad/s.
    last: Option<[DVec3; 2]>,
    /// What fluid and gravity gave the block at the last exchange: acceleration, m/s², and torque over the
    /// density of the rock, m⁵/s²; of a block whose motion is given its acceleration and that of its spin, rad/s².
    given: [DVec3; 2],
}

impl InnerFluid {
    /// The load under which the rock alone moves as it does with the fluid inside it, from what its cells felt over
    /// the last `dt` (s) in a fluid of the density `density` (kg/m³).
    pub fn load(
        &mut self,
        felt: &Felt,
        pose: &Pose,
        matter: &Matter,
        density: f64,
        dt: f64,
    ) -> Load {
        let load = sum(felt.flow, felt.buoyancy);
        let known = self.last;
        let [linear, angular] = self.rates(pose, dt);

        let rock = matter.mass / matter.volume;
        // Over its volume: the fluid that it displaces, what goes with it, and what it seems to have more.
        let whole = density * (load.entrained + load.missing) / matter.volume;
        let held = density * load.entrained / matter.volume;
        let inner = whole.min(held + 0.5 * rock);
        let inner_turning = whole.min(0.5 * (held + rock));
        let [more, more_turning] = [matter.around.mass, matter.around.inertia]
            .map(|most| 0.5 * (most * whole - rock).max(0.0));
        let force = load.force / matter.volume + inner * linear + rock * matter.gravity;
        // At the start what does not come from motion: weight and buoyancy.
        let [before, turned] = match known {
            Some(_) => self.given,
            None => [
                felt.buoyancy.force / matter.mass + matter.gravity,
                felt.buoyancy.torque() / rock,
            ],
        };
        let acceleration = (force + more * before) / (rock + more);
        let torque = load.torque() + inner_turning * (matter.inertia * angular);
        let turning = (torque + more_turning * turned) / (rock + more_turning);
        self.given = [acceleration, turning];
        Load {
            force: matter.mass * (acceleration - matter.gravity),
            // A torque is the skew part of a moment.
            moment: load.moment + 0.5 * skew(rock * turning - load.torque()),
            ..load
        }
    }

    /// Whether it has given a load.
    pub fn knows(&self) -> bool {
        self.last.is_some()
    }

    /// How fast velocity and spin have changed over the last `dt` (s), m/s² and rad/s².
    fn rates(&mut self, pose: &Pose, dt: f64) -> [DVec3; 2] {
        let now = [pose.velocity, spin(pose)];
        let known = self.last.replace(now);
        known.map_or([DVec3::ZERO; 2], |[velocity, spin]| {
            [(now[0] - velocity) / dt, (now[1] - spin) / dt]
        })
    }

    /// The same for a block whose motion is given: no load changes it.
    pub fn follow(&mut self, pose: &Pose, dt: f64) {
        self.given = self.rates(pose, dt);
    }

    /// What the fluid around such a block does to it, of what its cells felt: without the inertia of the fluid inside,
    /// whose tensor (m⁵) is that of the shape.
    pub fn around(&self, felt: &Felt, inertia: DMat3, volume: f64, density: f64) -> Load {
        let displaced = density * (felt.flow.entrained + felt.flow.missing);
        let [linear, angular] = self.given;
        let turning = displaced / volume * (inertia * angular);
        Load {
            force: felt.flow.force + displaced * linear,
            moment: felt.flow.moment + 0.5 * skew(turning),
            ..felt.flow
        }
    }

    /// As numbers, for a checkpoint.
    pub fn to_numbers(self) -> [f64; 13] {
        let [velocity, spin] = self.last.unwrap_or_default();
        let mut all = [0.0; 13];
        all[0] = f64::from(u8::from(self.last.is_some()));
        let vectors = [velocity, spin, self.given[0], self.given[1]];
        for (place, vector) in all[1..].chunks_exact_mut(3).zip(vectors) {
            place.copy_from_slice(&vector.to_array());
        }
        all
    }

    /// From what [`InnerFluid::to_numbers`] gave.
    pub fn from_numbers(numbers: &[f64; 13]) -> Self {
        let vector = |n: usize| DVec3::new(numbers[n], numbers[n + 1], numbers[n + 2]);
        Self {
            last: (numbers[0] != 0.0).then(|| [vector(1), vector(4)]),
            given: [vector(7), vector(10)],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    /// 2 m³ in water, of half to three times its density.
    fn block(ratio: f64) -> (Matter, Load) {
        let matter = Matter {
            mass: 2000.0 * ratio,
            volume: 2.0,
            inertia: DMat3::from_diagonal(DVec3::new(1.0, 2.0, 3.0)),
            gravity: DVec3::Z * -10.0,
            around: Around {
                mass: 5.0,
                inertia: 10.0,
            },
        };
        let load = Load {
            entrained: 1.5,
            missing: 0.5,
            ..Load::default()
        };
        (matter, load)
    }

    fn flow(flow: Load) -> Felt {
        let buoyancy = Load::default();
        Felt { flow, buoyancy }
    }

    fn pose(velocity: DVec3, spin: DVec3) -> Pose {
        Pose::rigid(DVec3::ZERO, DQuat::IDENTITY, velocity, spin)
    }

    #[test]
    fn a_steady_load_comes_through_whole() {
        let (matter, mut load) = block(0.5);
        load.force = DVec3::new(3.0, 0.0, 20_000.0);
        load.moment = skew(DVec3::new(1.0, -2.0, 5.0)) * 0.5;
        let mut inner = InnerFluid::default();
        let mut felt = Load::default();
        for _ in 0..500 {
            felt = inner.load(&flow(load), &pose(DVec3::X, DVec3::Y), &matter, 1000.0, 0.1);
        }
        assert!((felt.force - load.force).length() < 1e-9, "{}", felt.force);
        assert!((felt.torque() - load.torque()).length() < 1e-9);
    }

    #[test]
    fn the_fluid_inside_gives_back_what_its_inertia_takes() {
        let (matter, mut load) = block(2.5);
        let (dt, rate, turn) = (0.1, DVec3::new(2.0, 0.0, -1.0), DVec3::new(0.0, 0.5, 2.0));
        load.force = -1000.0 * 2.0 * rate;
        load.moment = 0.5 * skew(-1000.0 * (matter.inertia * turn));
        let mut inner = InnerFluid::default();
        let mut felt = Load::default();
        for n in 0..200 {
            let t = dt * f64::from(n);
            felt = inner.load(&flow(load), &pose(t * rate, t * turn), &matter, 1000.0, dt);
        }
        assert!(felt.force.length() < 1e-9, "{}", felt.force);
        assert!(felt.torque().length() < 1e-9, "{}", felt.torque());
    }

    /// m v' = F − m_a v', the added mass answering one step late: it grows by m_a/m a step without a remedy.
    #[test]
    fn light_blocks_do_not_swing() {
        let (matter, mut load) = block(0.5);
        let (dt, added, pull) = (0.1, 2500.0, DVec3::X * 1000.0);
        let mut inner = InnerFluid::default();
        let (mut velocity, mut before) = (DVec3::ZERO, DVec3::ZERO);
        for _ in 0..200 {
            let rate = (velocity - before) / dt;
            load.force = pull - (added + 2000.0) * rate - matter.mass * matter.gravity;
            let felt = inner.load(
                &flow(load),
                &pose(velocity, DVec3::ZERO),
                &matter,
                1000.0,
                dt,
            );
            before = velocity;
            velocity += (felt.force / matter.mass + matter.gravity) * dt;
        }
        let rate = (velocity - before) / dt;
        assert!(
            (rate - pull / (matter.mass + added)).length() < 1e-9,
            "{rate}"
        );
    }

    #[test]
    fn it_survives_its_numbers() {
        let (matter, load) = block(0.5);
        let mut inner = InnerFluid::default();
        assert_eq!(InnerFluid::from_numbers(&inner.to_numbers()), inner);
        inner.load(&flow(load), &pose(DVec3::X, DVec3::Y), &matter, 1000.0, 0.1);
        assert_eq!(InnerFluid::from_numbers(&inner.to_numbers()), inner);
    }
}
