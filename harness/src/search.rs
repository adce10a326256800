//! Which finder of pairs a scene of blocks runs with.

use riprap::{
    Result,
    broadphase::{Broadphase, HostBroadphase, Item},
    scene::Scene,
    simulation::Dry,
};

/// A finder on the host or on a device.
pub enum Finder {
    /// On the host.
    Host(HostBroadphase),
}

impl Finder {
    /// Where it searches, in a line.
    pub fn describe(&self) -> String {
        match self {
            Self::Host(_) => "on the host".into(),
        }
    }
}

impl Broadphase for Finder {
    async fn pairs(&mut self, items: &[Item]) -> Result<Vec<[u32; 2]>> {
        match self {
            Self::Host(finder) => finder.pairs(items).await,
        }
    }
}

/// The blocks of `scene` with the finder that it asks for, on the adapter called `adapter` or the
/// best one.
///
/// # Errors
/// Those of [`Dry::new`] and of the device.
pub fn open(scene: &Scene, _adapter: Option<&str>) -> Result<Dry<Finder>> {
    pollster::block_on(Dry::new(scene, Finder::Host(HostBroadphase)))
}

/// Takes `steps` steps.
///
/// # Errors
/// Those of [`Dry::advance`], and a device that does not answer.
pub fn drive(simulation: &mut Dry<Finder>, steps: u64) -> Result<()> {
    pollster::block_on(simulation.advance(steps))
}
