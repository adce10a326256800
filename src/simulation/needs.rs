//! What a scene asks of a device.

use crate::{
    Result,
    lattice::{Grid, Memory, Setup, memory},
    psm,
    scene::{Scene, build::lattice_setup},
    units::Units,
};

/// Features, limits and bytes of a scene on an adapter.
#[derive(Clone, Debug)]
pub struct Needs {
    /// Features to request.
    pub features: wgpu::Features,
    /// Limits to request: the least that the scene runs with.
    pub limits: wgpu::Limits,
    /// Bytes and bindings of the fluid.
    pub memory: Memory,
    /// The lattice fluid that will run.
    pub setup: Setup,
}

impl Needs {
    /// The needs of `scene` on `adapter`.
    ///
    /// # Errors
    /// What the scene lacks, or [`crate::Error::Limit`] if the adapter cannot hold it.
    pub fn of(scene: &Scene, adapter: &wgpu::Adapter) -> Result<Self> {
        let units = Units::of(scene)?;
        let software = adapter.get_info().device_type == wgpu::DeviceType::Cpu;
        let setup = lattice_setup(scene, &units, software.then(|| adapter.features()))?;
        let grid = Grid::new(&setup)?;
        let has = adapter.limits();
        let memory = memory(&setup, &grid, &has)?;
        let mut limits = wgpu::Limits::downlevel_defaults().using_alignment(has.clone());
        let binding = memory
            .largest_binding
            .max(limits.max_storage_buffer_binding_size);
        limits.max_storage_buffer_binding_size = binding.min(has.max_storage_buffer_binding_size);
        limits.max_buffer_size = binding.max(limits.max_buffer_size).min(has.max_buffer_size);
        let mut bindings = memory
            .most_bindings
            .max(limits.max_storage_buffers_per_shader_stage);
        if scene.has_blocks() {
            bindings = bindings.max(psm::MOST_BINDINGS);
            // What they take is known once they are placed, and changes as they move.
            limits.max_storage_buffer_binding_size = has.max_storage_buffer_binding_size;
            limits.max_buffer_size = has.max_buffer_size;
        }
        limits.max_storage_buffers_per_shader_stage =
            bindings.min(has.max_storage_buffers_per_shader_stage);
        Ok(Self {
            features: (adapter.features() & wgpu::Features::TIMESTAMP_QUERY) | setup.features(),
            limits,
            memory,
            setup,
        })
    }
}
