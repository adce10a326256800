//! A device for tests, which runs a lattice, or single kernels on poisoned buffers.

use crate::{
    gpu,
    scene::{for_kernels, kernels},
};
use riprap::{
    Result,
    gpu::{
        kernel::{Kernel, submit_pass},
        link::Program,
        readback::Readback,
    },
    lattice::{Lattice, Observer, Populations, Setup, State},
    scene::{Kernels, Scene},
    simulation::Simulation,
    wgpu::{self, util::DeviceExt},
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
    /// The [selected](gpu::selected) adapter with all its features and limits; panics with the install hint if there is none.
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

    /// Largest number of bindings for the populations if each kernel has at most five others.
    pub fn most_bindings(&self) -> u32 {
        (self.device.limits().max_storage_buffers_per_shader_stage - 5).min(27)
    }

    /// The value of a future; panics if it takes more than 300 s.
    pub fn wait<T>(&self, future: impl Future<Output = T>) -> T {
        gpu::drive(&self.device, Duration::from_secs(300), "a test", future).unwrap()
    }

    /// A simulation of a scene, with [these kernels](kernels) unless the scene names others.
    pub fn simulation(&self, scene: &Scene) -> Result<Simulation> {
        let scene = match scene.run.kernels {
            Kernels::Auto => for_kernels(scene, kernels()),
            _ => scene.clone(),
        };
        self.wait(Simulation::new(&self.device, &self.queue, &scene))
    }

    /// A lattice that starts from a state.
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
            submit_pass(&self.device, &self.queue, |pass| {
                chunk.iter().for_each(|_| lattice.record(pass));
            });
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

/// Content of memory before a kernel writes it.
pub const POISON: u32 = 0xdead_beef;

/// A device on which kernels run one at a time.
pub struct Workbench {
    /// The device.
    pub rig: Rig,
    grid: Option<u32>,
}

impl Workbench {
    /// A workbench with workgroups in rows of `width`, as used beyond 65 535 of them; `None` for a single row.
    pub fn new(width: Option<u32>) -> Self {
        Self {
            rig: Rig::new(),
            grid: width,
        }
    }

    /// A buffer with these values and all usages.
    pub fn buffer<T: bytemuck::Pod>(&self, values: &[T]) -> wgpu::Buffer {
        let contents = bytemuck::cast_slice(values);
        let usage = wgpu::BufferUsages::STORAGE
            | wgpu::BufferUsages::UNIFORM
            | wgpu::BufferUsages::COPY_SRC
            | wgpu::BufferUsages::COPY_DST;
        self.rig
            .device
            .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: None,
                contents,
                usage,
            })
    }

    /// A buffer of 32-bit words set to [`POISON`].
    pub fn poisoned(&self, words: usize) -> wgpu::Buffer {
        self.buffer(&vec![POISON; words])
    }

    /// Runs the entry point of a program, of the same name as its file, for `invocations`; `constants` are those of its
    /// family of kernels.
    pub fn run(
        &self,
        program: &Program,
        entry: &str,
        constants: &[(&str, f64)],
        buffers: &[(&str, &wgpu::Buffer)],
        invocations: usize,
    ) {
        let device = &self.rig.device;
        let linked = program.link().unwrap();
        let constants = linked.constants_of(constants);
        let kernel = Kernel::new(device, &linked, entry, &constants).unwrap();
        let bind = kernel.bind(device, buffers).unwrap();
        let groups = invocations.div_ceil(64) as u32;
        submit_pass(device, &self.rig.queue, |pass| match self.grid {
            Some(width) => {
                // With a last row that is not full, and one row too many.
                let grid = [width, groups.div_ceil(width) + 1];
                kernel.record_grid(pass, &bind, grid);
            }
            None => kernel.record(pass, &bind, groups),
        });
    }

    /// The values of a buffer.
    pub fn read<T: bytemuck::Pod>(&self, buffer: &wgpu::Buffer) -> Vec<T> {
        let count = buffer.size() as usize / size_of::<T>();
        let mut readback = Readback::default();
        let Rig { device, queue } = &self.rig;
        self.rig
            .wait(readback.read(device, queue, buffer, count))
            .unwrap()
    }
}
