//! Features and limits that a scene needs on an adapter.

use crate::{
    Result,
    gpu::Processor,
    lattice::{self, Grid, Memory, memory},
    psm, rock,
    scene::{Scene, build::lattice_setup},
    simulation::checkpoint::Kind,
    sph,
    units::Units,
};

/// Features and limits that a scene needs on an adapter.
#[derive(Clone, Debug)]
pub struct Needs {
    /// Features to request.
    pub features: wgpu::Features,
    /// Limits to request: the lowest with which the scene runs.
    pub limits: wgpu::Limits,
    /// Needs of the fluid, if it is on a lattice.
    pub lattice: Option<LatticeNeeds>,
}

/// Needs of a fluid on a lattice.
#[derive(Clone, Debug)]
pub struct LatticeNeeds {
    /// Memory in bytes and bindings.
    pub memory: Memory,
    /// The setup of the fluid, for [`Simulation::with_needs`](super::Simulation::with_needs).
    pub setup: lattice::Setup,
}

impl Needs {
    /// The needs of `scene` on `adapter`.
    ///
    /// # Errors
    /// If the scene is incomplete; [`crate::Error::Limit`] if the adapter cannot hold it.
    pub fn of(scene: &Scene, adapter: &wgpu::Adapter) -> Result<Self> {
        let has = adapter.limits();
        let kind = Kind::of(scene);
        let lattice = match kind {
            Kind::Lattice => Some(LatticeNeeds::of(scene, adapter)?),
            Kind::Rock | Kind::Particles => None,
        };
        let mut limits = wgpu::Limits::downlevel_defaults().using_alignment(has.clone());
        let mut buffers = limits.max_storage_buffers_per_shader_stage;
        if let Some(LatticeNeeds { memory, .. }) = &lattice {
            let binding = memory
                .largest_binding
                .max(limits.max_storage_buffer_binding_size);
            limits.max_storage_buffer_binding_size =
                binding.min(has.max_storage_buffer_binding_size);
            limits.max_buffer_size = binding.max(limits.max_buffer_size).min(has.max_buffer_size);
            buffers = buffers.max(memory.most_bindings);
        }
        if scene.has_blocks() || kind != Kind::Lattice {
            // The sizes of the buffers for blocks in cells, pairs and neighbours are known only at run time, and vary.
            limits.max_storage_buffer_binding_size = has.max_storage_buffer_binding_size;
            limits.max_buffer_size = has.max_buffer_size;
            buffers = buffers.max(rock::broadphase::MAX_STORAGE_BUFFERS);
            buffers = buffers.max(match kind {
                Kind::Lattice => psm::MAX_STORAGE_BUFFERS,
                Kind::Particles => sph::MAX_STORAGE_BUFFERS,
                Kind::Rock => 0,
            });
        }
        limits.max_storage_buffers_per_shader_stage =
            buffers.min(has.max_storage_buffers_per_shader_stage);
        let features = lattice.as_ref().map_or(wgpu::Features::empty(), |lattice| {
            (adapter.features() & wgpu::Features::TIMESTAMP_QUERY) | lattice.setup.features()
        });
        Ok(Self {
            features,
            limits,
            lattice,
        })
    }
}

impl LatticeNeeds {
    fn of(scene: &Scene, adapter: &wgpu::Adapter) -> Result<Self> {
        let units = Units::of(scene)?;
        let processor = scene.run.kernels.processor(&adapter.get_info());
        let cpu = (processor == Processor::Cpu).then(|| adapter.features());
        let setup = lattice_setup(scene, &units, cpu)?;
        let memory = memory(&setup, &Grid::new(&setup)?, &adapter.limits())?;
        Ok(Self { memory, setup })
    }
}
