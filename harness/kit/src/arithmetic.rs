//! The arithmetic ceiling of an adapter: how many products and sums it does a second where it does nothing else.

use super::gpu;
use riprap::{
    Error,
    gpu::{kernel::Kernel, link::Program},
    wgpu,
};

/// Turns of the loop: short, since drivers may end long ones.
const TURNS: u32 = 64;
/// Products and sums of a turn: 32 of each, of four components.
pub const FLOPS: u64 = 2 * 32 * 4;
/// Workgroups of 64 on a GPU: large ones hold 270 000 invocations, and this is as many fifteen times over. A dispatch
/// may have no more than 65535.
const GROUPS: u32 = 65_535;
/// The same on a CPU, whose cores each take one after the other.
const CPU_GROUPS: u32 = 4096;

/// Products and sums of vectors in registers.
pub struct Arithmetic {
    kernel: Kernel,
    bind: wgpu::BindGroup,
    groups: u32,
}

/// The program of the kernel `multiply_add`.
pub fn program() -> Program {
    Program::new("multiply_add").text("multiply_add", include_str!("kernels/multiply_add.wgsl"))
}

impl Arithmetic {
    /// The kernel and its numbers.
    ///
    /// # Errors
    /// If the device refuses it.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Self, Error> {
        let groups = match gpu::is_software(&device.adapter_info()) {
            true => CPU_GROUPS,
            false => GROUPS,
        };
        let linked = program().link()?;
        let kernel = Kernel::new(
            device,
            &linked,
            "multiply_add",
            &[("TURNS", f64::from(TURNS))],
        )?;
        // Numbers that stay finite: x ← 0.5 x + 0.5 goes to 1.
        let factors = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("factors"),
            size: 32,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let half: Vec<u8> = [0.5f32; 8].iter().flat_map(|x| x.to_le_bytes()).collect();
        queue.write_buffer(&factors, 0, &half);
        let sums = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("sums"),
            size: u64::from(groups) * 64 * 16,
            usage: wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        });
        let bind = kernel.bind(device, &[("factors", &factors), ("sums", &sums)])?;
        Ok(Self {
            kernel,
            bind,
            groups,
        })
    }

    /// Products and sums of a dispatch.
    pub fn flops(&self) -> f64 {
        f64::from(self.groups) * 64.0 * f64::from(TURNS) * FLOPS as f64
    }

    /// Records a dispatch.
    pub fn record(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.kernel.record(pass, &self.bind, self.groups);
    }
}
