//! Which finder of pairs a scene of blocks runs with.

use crate::gpu;
use riprap::{
    Error, Result,
    rock::broadphase::{Aabb, AutoBroadphase, Broadphase, DeviceBroadphase, HostBroadphase},
    scene::{
        Scene, Search,
        build::{LeftOut, block_setup},
    },
    simulation::Dry,
    wgpu,
};
use std::{path::Path, time::Duration};

/// A search takes milliseconds; a device that is silent for so long is stuck.
const PATIENCE: Duration = Duration::from_secs(60);

/// Storage buffers of a kernel of the finder.
pub const BUFFERS: u32 = 6;

/// A finder on the host or on a device.
pub enum Finder {
    /// On the host.
    Host(HostBroadphase),
    /// On a device.
    Device {
        /// The finder.
        finder: Box<DeviceBroadphase>,
        /// Its device, to be waited for.
        device: wgpu::Device,
        /// Name, back end and driver.
        name: String,
    },
}

impl Finder {
    /// The finder that `scene` asks for where there are `parts`, on the adapter called `adapter` or the
    /// best one.
    fn new(scene: &Scene, parts: usize, adapter: Option<&str>) -> Result<Self> {
        let many = parts >= AutoBroadphase::GPU_CROSSOVER;
        let adapter = match scene.rock.search {
            Search::Device => gpu::pick(adapter)?,
            Search::Auto if many => match gpu::pick(adapter) {
                Ok(found) if !gpu::is_software(&found.get_info()) => found,
                _ => return Ok(Self::Host(HostBroadphase)),
            },
            Search::Auto | Search::Host => return Ok(Self::Host(HostBroadphase)),
        };
        let has = adapter.limits();
        let limits = wgpu::Limits {
            max_storage_buffers_per_shader_stage: has
                .max_storage_buffers_per_shader_stage
                .min(BUFFERS),
            max_storage_buffer_binding_size: has.max_storage_buffer_binding_size,
            max_buffer_size: has.max_buffer_size,
            ..wgpu::Limits::downlevel_defaults().using_alignment(has)
        };
        let (device, queue) = gpu::open(&adapter, wgpu::Features::empty(), limits)?;
        Ok(Self::Device {
            finder: Box::new(DeviceBroadphase::new(&device, &queue)?),
            name: gpu::describe(&adapter.get_info()),
            device,
        })
    }

    /// Where it searches, in a line.
    pub fn describe(&self) -> String {
        match self {
            Self::Host(_) => "pairs on the host".into(),
            Self::Device { name, .. } => format!("pairs on {name}"),
        }
    }
}

impl Broadphase for Finder {
    async fn pairs(&mut self, items: &[Aabb]) -> Result<Vec<[u32; 2]>> {
        match self {
            Self::Host(finder) => finder.pairs(items).await,
            Self::Device { finder, device, .. } => {
                gpu::drive(device, PATIENCE, "a search for pairs", finder.pairs(items))?
            }
        }
    }
}

/// The blocks of `scene`, which was read from `file`, with the finder that it asks for.
///
/// # Errors
/// Those of [`Dry::new`], with their line in the file, and of the device.
pub fn open(scene: &Scene, file: &Path, adapter: Option<&str>) -> Result<Dry<Finder>> {
    let made = block_setup(scene).and_then(|setup| {
        let parts = setup
            .setup
            .blocks
            .iter()
            .map(|block| block.shape.parts().len());
        let finder = Finder::new(scene, parts.sum(), adapter)?;
        pollster::block_on(Dry::of(scene, setup, finder))
    });
    made.map_err(|error| located(error, file))
}

/// The error of a scene that was read from `file`, with its line there.
pub fn located(error: Error, file: &Path) -> Error {
    match std::fs::read_to_string(file) {
        Ok(text) => Scene::locate(error, &text, &file.display().to_string()),
        Err(_) => error,
    }
}

/// What is missing of rock masses, a line for each.
pub fn left_out(all: &[LeftOut]) -> impl Iterator<Item = String> {
    let line = |lost: &LeftOut| {
        format!(
            "{} pieces of {}, {:.1} % of it: smaller or thinner than its smallest_volume and \
             smallest_thickness",
            lost.pieces,
            lost.mass,
            100.0 * lost.share
        )
    };
    all.iter().map(line)
}

/// Takes `steps` steps.
///
/// # Errors
/// Those of [`Dry::advance`], and a device that does not answer.
pub fn drive(simulation: &mut Dry<Finder>, steps: u64) -> Result<()> {
    pollster::block_on(simulation.advance(steps))
}
