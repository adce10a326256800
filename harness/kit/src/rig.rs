//! A device for tests, and running a lattice on it.

use crate::gpu;
use riprap::{
    lattice::{Lattice, Observer, Populations, Setup, State},
    wgpu,
};
use std::time::Duration;

/// A device and its queue.
pub struct Rig {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
}

impl Default for Rig {
    fn default() -> Self {
        Self::new()
    }
}

impl Rig {
    /// The [selected](gpu::selected) adapter with all it offers; panics with the install hint where there is none.
    pub fn new() -> Self {
        Self::with_limits(gpu::selected().unwrap().limits())
    }

    /// The same with these limits.
    pub fn with_limits(limits: wgpu::Limits) -> Self {
        let adapter = gpu::selected().unwrap();
        let wide = adapter.features() & wgpu::Features::SHADER_INT64;
        let (device, queue) = gpu::open(&adapter, wide, limits).unwrap();
        Self { device, queue }
    }

    /// Bindings for the populations where each kernel has at most five others.
    pub fn most_bindings(&self) -> u32 {
        (self.device.limits().max_storage_buffers_per_shader_stage - 5).min(27)
    }

    /// The value of a future; panics if it takes more than 300 s.
    pub fn wait<T>(&self, future: impl Future<Output = T>) -> T {
        gpu::drive(&self.device, Duration::from_secs(300), "a test", future).unwrap()
    }

    /// A lattice started from a state.
    pub fn start(&self, setup: Setup, state: &State, non_equilibrium: bool) -> Lattice {
        let mut lattice = Lattice::new(&self.device, setup).unwrap();
        lattice
            .start(&self.device, &self.queue, state, non_equilibrium)
            .unwrap();
        lattice
    }

    /// Submits `steps` steps.
    pub fn run(&self, lattice: &mut Lattice, steps: usize) {
        // Small submissions keep each wait short on slow adapters.
        for chunk in (0..steps).collect::<Vec<_>>().chunks(64) {
            let mut encoder = self.device.create_command_encoder(&Default::default());
            {
                let mut pass = encoder.begin_compute_pass(&Default::default());
                for _ in chunk {
                    lattice.record(&mut pass);
                }
            }
            self.queue.submit([encoder.finish()]);
        }
    }

    /// The populations of a lattice.
    pub fn populations(&self, lattice: &mut Lattice) -> Populations {
        self.wait(lattice.populations(&self.device, &self.queue))
            .unwrap()
    }

    /// Density and velocity of a lattice.
    pub fn state(&self, lattice: &mut Lattice) -> State {
        let mut observer = Observer::new(&self.device, lattice).unwrap();
        self.wait(observer.state(&self.device, &self.queue, lattice))
            .unwrap()
    }
}
