//! Kind of processor for which kernels are compiled.

/// Kind of processor. Kernels have a variant for each; their results agree up to the order of sums.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Processor {
    /// A CPU, which executes the invocations of a workgroup one after the other.
    Cpu,
    /// A GPU.
    Gpu,
}

impl Processor {
    /// The kind of an adapter.
    pub fn of(info: &wgpu::AdapterInfo) -> Self {
        match info.device_type {
            wgpu::DeviceType::Cpu => Self::Cpu,
            _ => Self::Gpu,
        }
    }
}
