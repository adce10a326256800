//! From what the fluid did to the solid in its cells to the load on a block.

use crate::{
    bodies::{Load, Pose},
    formula::Formula,
    immersed::spin,
};
use glam::{DMat3, DVec3};

/// What acts on fluid and rock everywhere.
///
/// The exchange in a partially saturated cell is weighted by B, and the body force b on the fluid by 1 − B, so
/// that ρ b ΣB is missing from it; and where the rock's gravity g is not all in b, pressure is counted from the
/// hydrostatic one, whose push is −ρ g Σε (Archimedes). Together: ρ b ΣB − ρ g Σε. With b = g this is
/// −ρ g Σ(ε − B), which at rest makes the whole load the buoyancy; with g = 0 the body force stands for a
/// pressure gradient; with b = 0 the water is weightless and only its buoyancy is felt.
#[derive(Clone, Debug, PartialEq)]
pub struct Ambient {
    /// Density of the fluid ρ, kg/m³.
    pub density: f64,
    /// Body force on the fluid per mass b, m/s², a formula of the place.
    pub acceleration: [Formula; 3],
    /// Gravity of the rock g, m/s².
    pub gravity: DVec3,
}

impl Ambient {
    /// Force and moment of the body force on what the block entrains: ρ b ΣB.
    pub fn push(&self, load: &Load, centre: DVec3) -> Load {
        let place = centre.to_array();
        let b = [0, 1, 2].map(|k| self.acceleration[k].eval_at(place, 0.0));
        spread(
            self.density * DVec3::from_array(b),
            load.entrained,
            load.entrained_moment,
        )
    }

    /// Buoyancy: −ρ g Σε.
    pub fn buoyancy(&self, load: &Load) -> Load {
        spread(
            -self.density * self.gravity,
            load.entrained + load.missing,
            load.entrained_moment + load.missing_moment,
        )
    }
}

/// A force per volume over a volume with a first moment.
fn spread(force: DVec3, volume: f64, moment: DVec3) -> Load {
    Load {
        force: force * volume,
        moment: outer(force, moment),
        ..Load::default()
    }
}

/// a ⊗ b.
fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

/// The sum of two loads on a block; the volumes are those of the first.
pub fn sum(a: Load, b: Load) -> Load {
    Load {
        force: a.force + b.force,
        moment: a.moment + b.moment,
        ..a
    }
}

/// The fluid inside a block, which goes where the block goes: the block feels its inertia through the cells, and
/// gets it back from here, since the water inside is not part of what the block's mass stands for.
///
/// That is the water within the block's surface, ρ Σε, and not only what the cells hold with the weight B: what
/// flows around a sphere moves as if the surface were where it is, at any viscosity, though B is small in cells
/// that are partly solid where the viscosity is low. A sphere released from rest shows it by its acceleration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Follower {
    /// Velocity and spin at the last exchange, m/s and rad/s.
    last: Option<[DVec3; 2]>,
    /// Smoothed acceleration, m/s² and rad/s².
    rate: [DVec3; 2],
}

/// Share of the newest acceleration in the smoothed one: contacts make accelerations rough, and the smoothing
/// must not last longer than the fluid needs to answer, a few steps.
const NEWEST: f64 = 0.5;

impl Follower {
    /// Notes how the block moves, `dt` (s) after the last time.
    pub fn follow(&mut self, pose: &Pose, dt: f64) {
        let now = [pose.velocity, spin(pose)];
        if let Some(last) = self.last {
            for k in 0..2 {
                let rate = (now[k] - last[k]) / dt;
                self.rate[k] += NEWEST * (rate - self.rate[k]);
            }
        }
        self.last = Some(now);
    }

    /// What the fluid inside a block takes of its load: ρ Σε times the acceleration, and the same of the turn,
    /// with the block's tensor of inertia for a density of one (m⁵, world) and its volume (m³).
    pub fn load(&self, density: f64, load: &Load, inertia: DMat3, volume: f64) -> Load {
        let [linear, angular] = self.rate;
        // Less than the block's volume where it reaches out of the domain.
        let inside = load.entrained + load.missing;
        let torque = density * inside / volume * (inertia * angular);
        let force = density * inside * linear;
        Load {
            force,
            // A torque is the skew part of a moment.
            moment: 0.5 * crate::bodies::skew(torque),
            ..Load::default()
        }
    }

    /// As numbers, for a checkpoint.
    pub fn to_numbers(self) -> [f64; 13] {
        let [velocity, spin] = self.last.unwrap_or_default();
        let mut all = [0.0; 13];
        all[0] = f64::from(u8::from(self.last.is_some()));
        let vectors = [velocity, spin, self.rate[0], self.rate[1]];
        for (place, vector) in all[1..].chunks_exact_mut(3).zip(vectors) {
            place.copy_from_slice(&vector.to_array());
        }
        all
    }

    /// From what [`Follower::to_numbers`] gave.
    pub fn from_numbers(numbers: &[f64; 13]) -> Self {
        let vector = |n: usize| DVec3::new(numbers[n], numbers[n + 1], numbers[n + 2]);
        Self {
            last: (numbers[0] != 0.0).then(|| [vector(1), vector(4)]),
            rate: [vector(7), vector(10)],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_torque_of_the_inner_fluid_is_that_of_its_inertia() {
        let mut follower = Follower::default();
        let pose = |spin: DVec3| Pose::rigid(DVec3::ZERO, glam::DQuat::IDENTITY, DVec3::ZERO, spin);
        follower.follow(&pose(DVec3::ZERO), 1.0);
        for n in 1..200 {
            follower.follow(&pose(DVec3::new(0.0, 0.5, 2.0) * f64::from(n)), 1.0);
        }
        let inside = Load {
            entrained: 0.5,
            missing: 0.25,
            ..Load::default()
        };
        let inertia = DMat3::from_diagonal(DVec3::new(1.0, 2.0, 3.0));
        let load = follower.load(1000.0, &inside, inertia, 1.0);
        let expected = DVec3::new(0.0, 750.0, 4500.0);
        assert!(
            (load.torque() - expected).length() < 1e-9,
            "{}",
            load.torque()
        );
    }

    #[test]
    fn a_follower_survives_its_numbers() {
        let mut follower = Follower::default();
        assert_eq!(Follower::from_numbers(&follower.to_numbers()), follower);
        let pose = Pose::rigid(DVec3::ONE, glam::DQuat::IDENTITY, DVec3::X, DVec3::Y);
        follower.follow(&pose, 0.1);
        assert_eq!(Follower::from_numbers(&follower.to_numbers()), follower);
    }
}
