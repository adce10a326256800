//! A tank of water with walls of boundary particles, on a device.

use glam::DVec3;
use kit::Rig;
pub use kit::tank::{lattice, resting, walls};
use riprap::{
    geometry::Pose,
    sph::{ExchangeResult, Setup, SphSolver, Water},
};

pub struct Tank {
    pub rig: Rig,
    pub particles: SphSolver,
    pub poses: Vec<Pose>,
}

impl Tank {
    /// Water at rest at `positions` with the given pressures.
    pub fn new(
        setup: Setup,
        poses: Vec<Pose>,
        positions: &[DVec3],
        pressure: impl Fn(DVec3) -> f64,
    ) -> Self {
        let still = vec![DVec3::ZERO; positions.len()];
        let pressures: Vec<f64> = positions.iter().map(|x| pressure(*x)).collect();
        Self::moving(setup, poses, positions, &still, &pressures)
    }

    /// Water in motion.
    pub fn moving(
        setup: Setup,
        poses: Vec<Pose>,
        positions: &[DVec3],
        velocities: &[DVec3],
        pressures: &[f64],
    ) -> Self {
        let rig = Rig::new();
        let Rig { device, queue } = &rig;
        let particles = SphSolver::new(device, queue, setup, positions, velocities, pressures);
        Self {
            particles: particles.unwrap(),
            poses,
            rig,
        }
    }

    pub fn advance(&mut self, time: f64) -> ExchangeResult {
        let Rig { device, queue } = &self.rig;
        let done = self.particles.advance(device, queue, &self.poses, time);
        self.rig.wait(done).unwrap()
    }

    pub fn water(&mut self) -> Water {
        let Rig { device, queue } = &self.rig;
        let water = self.particles.water(device, queue);
        self.rig.wait(water).unwrap()
    }
}
