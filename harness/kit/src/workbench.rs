//! A kernel by itself on buffers that are full of rubbish.

use crate::Rig;
use riprap::{
    gpu::{kernel::Kernel, link::Program, readback::Readback},
    wgpu,
};

/// What memory holds before a kernel writes it.
pub const POISON: u32 = 0xdead_beef;

/// A device on which kernels run one at a time.
pub struct Workbench {
    /// The device.
    pub rig: Rig,
    grid: Option<u32>,
}

impl Workbench {
    /// Workgroups in rows of `width`, as beyond 65 535 of them; `None`: in one row.
    pub fn new(width: Option<u32>) -> Self {
        Self {
            rig: Rig::new(),
            grid: width,
        }
    }

    /// A buffer with these values, for every use.
    pub fn buffer<T: bytemuck::Pod>(&self, values: &[T]) -> wgpu::Buffer {
        use wgpu::util::DeviceExt;
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

    /// A buffer of 32-bit words, each of them [`POISON`].
    pub fn poisoned(&self, words: usize) -> wgpu::Buffer {
        self.buffer(&vec![POISON; words])
    }

    /// Runs the entry point of a program, of the same name as its file, for `invocations`; `constants` are those of its
    /// family.
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
        let mut encoder = device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            let groups = invocations.div_ceil(64) as u32;
            match self.grid {
                Some(width) => {
                    // The last row is not full, and there is one too many.
                    let grid = [width, groups.div_ceil(width) + 1];
                    kernel.record_grid(&mut pass, &bind, grid);
                }
                None => kernel.record(&mut pass, &bind, groups),
            }
        }
        self.rig.queue.submit([encoder.finish()]);
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
