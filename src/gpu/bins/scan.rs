//! Merrill & Grimshaw 2009, reduce-then-scan: replaces each value by the sum of all preceding values.

use super::WORKGROUP;
use crate::gpu::buffers::zeroed;
use crate::{
    Result,
    gpu::{kernel::Kernel, link::Program},
};

/// Values per invocation.
const RUN: u32 = 64;

/// The kernels of an exclusive scan of `u32`. Sums saturate at 2³² − 1.
#[derive(Debug)]
pub struct Scan {
    sum: Kernel,
    spread: Kernel,
}

/// The scan of one buffer, ready to be recorded.
#[derive(Debug)]
pub struct ScanOf {
    /// Levels from many runs to one: bindings of the upsweep and of the downsweep, and number of runs.
    steps: Vec<(wgpu::BindGroup, wgpu::BindGroup, u32)>,
    total: wgpu::Buffer,
}

impl Scan {
    /// Compiles the kernels.
    ///
    /// # Errors
    /// [`crate::Error::Limit`] if the device cannot run them.
    pub fn new(device: &wgpu::Device) -> Result<Self> {
        let kernel = |name| Kernel::new(device, &Program::new(name).link()?, name, &[]);
        Ok(Self {
            sum: kernel("scan_sum")?,
            spread: kernel("scan_spread")?,
        })
    }

    /// Prepares the scan of all of `values`, a storage buffer of `u32`.
    ///
    /// # Errors
    /// [`crate::Error::Binding`] if the bindings of a kernel differ from the expected ones.
    pub fn of(&self, device: &wgpu::Device, values: &wgpu::Buffer) -> Result<ScanOf> {
        let mut lengths = vec![(values.size() / 4) as u32];
        while lengths.len() == 1 || lengths[lengths.len() - 1] > 1 {
            lengths.push(lengths[lengths.len() - 1].div_ceil(RUN));
        }
        let sums = lengths[1..]
            .iter()
            .map(|&n| zeroed(device, "sums of runs", 4 * u64::from(n)));
        let levels: Vec<_> = std::iter::once(values.clone()).chain(sums).collect();
        let total = levels[levels.len() - 1].clone();
        // The top level has one run, which starts from zero; its sum remains as the total.
        let nothing = zeroed(device, "nothing", 4);
        let steps = (1..levels.len()).map(|k| {
            let (values, sums) = (&levels[k - 1], &levels[k]);
            let starts = if k + 1 == levels.len() {
                &nothing
            } else {
                sums
            };
            let up = [("values", values), ("run_sums", sums)];
            let down = [("scanned", values), ("run_starts", starts)];
            Ok((
                self.sum.bind(device, &up)?,
                self.spread.bind(device, &down)?,
                lengths[k],
            ))
        });
        Ok(ScanOf {
            steps: steps.collect::<Result<_>>()?,
            total,
        })
    }

    /// Records the scan into the caller's pass.
    pub fn record(&self, pass: &mut wgpu::ComputePass<'_>, of: &ScanOf) {
        for (up, _, runs) in &of.steps {
            self.sum.record(pass, up, runs.div_ceil(WORKGROUP));
        }
        for (_, down, runs) in of.steps.iter().rev() {
            self.spread.record(pass, down, runs.div_ceil(WORKGROUP));
        }
    }
}

impl ScanOf {
    /// The sum of all values, one `u32`; `u32::MAX` if the sum is at least `u32::MAX`.
    pub fn total(&self) -> &wgpu::Buffer {
        &self.total
    }
}
