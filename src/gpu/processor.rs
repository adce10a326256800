//! What kernels are made for.

/// What computes. Kernels have a form for each; their results agree up to the order of sums.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Processor {
    /// A CPU, which walks through the invocations of a workgroup one after the other.
    Cpu,
    /// A GPU.
    Gpu,
}

impl Processor {
    /// That of an adapter.
    pub fn of(info: &wgpu::AdapterInfo) -> Self {
        match info.device_type {
            wgpu::DeviceType::Cpu => Self::Cpu,
            _ => Self::Gpu,
        }
    }
}
