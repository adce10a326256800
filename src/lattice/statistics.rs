//! Means and covariances over time of density and velocity, on the device.

use super::{
    CellPass, Lattice, Observer,
    cell_kernels::{CellDispatch, uniform},
    fluid::Dispatch,
    gather::Gather,
};
use crate::{
    Error, Result,
    gpu::{buffers::zeroed, kernel::largest_binding, link::Program, readback::Readback},
};
use bytemuck::{Pod, Zeroable};
use std::ops::Range;

/// Number of samples per block.
const BLOCK: u64 = 256;
/// Numbers per cell: 4 means, 7 covariances, and as many sums of the open block.
const PLANES: usize = 22;

/// Number of cells whose values are stored together, as in `kernels/lattice/statistics.wgsl`.
const GROUP: usize = 64;

/// Index of the value `plane` of cell `n` of a part.
fn place(plane: usize, n: usize) -> usize {
    (n / GROUP * PLANES + plane) * GROUP + n % GROUP
}

/// A mean or a covariance over time, lattice units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Statistic {
    /// Mean of ρ − 1.
    Excess,
    /// Mean of a component of the velocity, 0 to 2.
    Velocity(u32),
    /// Mean square of the fluctuations of ρ.
    ExcessVariance,
    /// Mean product of the fluctuations of two components of the velocity: xx, yy, zz, xy, yz, xz, 0 to 5.
    ReynoldsStress(u32),
}

impl Statistic {
    /// Its plane among the numbers of a cell.
    fn plane(self) -> Result<u32> {
        match self {
            Self::Excess => Ok(0),
            Self::Velocity(axis @ 0..3) => Ok(1 + axis),
            Self::ExcessVariance => Ok(4),
            Self::ReynoldsStress(pair @ 0..6) => Ok(5 + pair),
            _ => {
                let message = format!(
                    "there is no {self:?}; a velocity has the components 0 to 2, a stress 0 to 5"
                );
                Err(Error::argument("statistic", message))
            }
        }
    }
}

/// Parameters of a dispatch on a block, with the layout of `kernels/lattice/statistics.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct StatisticsPass {
    /// The plane that is written to the output.
    pub plane: u32,
    /// Samples of the open block.
    pub samples: f32,
    /// Their fraction of all samples.
    pub weight: f32,
    /// Padding.
    pub pad: u32,
}

/// The state of all cells between two samples.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct StatisticsState {
    /// Number of samples in complete blocks.
    pub merged: u64,
    /// Samples of the open block.
    pub open: u64,
    /// Means, covariances, sums and sums of products, each on all cells, x fastest; empty without samples.
    #[cfg_attr(feature = "checkpoint", serde(with = "crate::gpu::plain_bytes"))]
    pub values: Vec<f32>,
}

/// Number of cells per buffer.
#[derive(Debug)]
struct Part {
    cells: Range<u32>,
    buffer: wgpu::Buffer,
    /// Kernels of the first sample, after an even and after an odd number of steps.
    begin: [Dispatch; 2],
    /// Kernels of the other samples.
    add: [Dispatch; 2],
}

/// Statistics over time of density and velocity: 88 bytes per cell.
///
/// Sums run over blocks of 256 samples, shifted by the mean so far, and each block is then combined with the previous ones, so
/// that neither means nor covariances drift in f32: after 3·10⁵ samples their errors are below 10⁻⁵.
///
/// ```
/// use riprap::{lattice::{Lattice, Setup, State, Statistics}, wgpu};
///
/// # fn main() -> riprap::Result<()> {
/// // Any device; this one does nothing, so that the example runs everywhere.
/// let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
/// let mut lattice = Lattice::new(&device, Setup::periodic([16, 16, 16], 0.01))?;
/// lattice.start(&device, &queue, &State::rest(16 * 16 * 16), true)?;
/// let mut statistics = Statistics::of_populations(&device, &lattice)?;
///
/// let mut encoder = device.create_command_encoder(&Default::default());
/// {
///     let mut pass = encoder.begin_compute_pass(&Default::default());
///     // An odd number of steps between samples: what alternates from step to step then averages out.
///     for _ in 0..5 {
///         lattice.record(&mut pass);
///     }
///     statistics.record(&device, &mut lattice, &mut pass)?;
/// }
/// queue.submit([encoder.finish()]);
/// assert_eq!(statistics.samples(), 1);
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Statistics {
    parts: Vec<Part>,
    program: Program,
    cells: usize,
    merged: u64,
    open: u64,
    /// Created when first read.
    field: Option<wgpu::Buffer>,
    gather: Gather,
    readback: Readback,
}

impl Statistics {
    /// Statistics of a lattice without blocks, read from its populations.
    ///
    /// # Errors
    /// If it has cells with solid, whose velocity only an [`Observer`] computes, or the device cannot hold the buffers.
    pub fn of_populations(device: &wgpu::Device, lattice: &Lattice) -> Result<Self> {
        if lattice.setup.solid_operator.is_some() {
            let message = "this lattice has blocks; use `of_observer`, which knows the velocity in their cells";
            return Err(Error::argument("solid_operator", message));
        }
        Self::new(device, lattice, "sample_populations", &[])
    }

    /// Statistics of the fields of `observer`: call [`Observer::record`] before each [`Statistics::record`].
    ///
    /// # Errors
    /// If the device cannot hold the buffers.
    pub fn of_observer(
        device: &wgpu::Device,
        lattice: &Lattice,
        observer: &Observer,
    ) -> Result<Self> {
        let [x, y, z] = observer.velocity();
        let buffers = [
            ("density", observer.density()),
            ("velocity_x", x),
            ("velocity_y", y),
            ("velocity_z", z),
        ];
        Self::new(device, lattice, "sample_observed", &buffers)
    }

    fn new(
        device: &wgpu::Device,
        lattice: &Lattice,
        sample: &'static str,
        sampled: &[(&str, &wgpu::Buffer)],
    ) -> Result<Self> {
        let cells = lattice.grid().cell_count();
        let bytes = 4 * PLANES as u64;
        let groups = largest_binding(&device.limits()) / bytes / GROUP as u64;
        let most = GROUP * groups.max(1) as usize;
        let program = lattice.cell_program("statistics").slot("sample", sample);
        let make = |first: usize| {
            let cells = first as u32..cells.min(first + most) as u32;
            let buffer = zeroed(
                device,
                "statistics",
                bytes * cells.len().next_multiple_of(GROUP) as u64,
            );
            let mut buffers = vec![("statistics", &buffer)];
            buffers.extend(sampled);
            let dispatch = |entry, odd| {
                let dispatch = CellDispatch {
                    program: &program,
                    entry,
                    pass: CellPass {
                        odd,
                        ..pass_over(&cells)
                    },
                    buffers: &buffers,
                    constants: &[],
                    invocations: cells.end - cells.start,
                };
                lattice.cell_dispatch(device, &dispatch)
            };
            let both = |entry| Ok::<_, Error>([dispatch(entry, 0)?, dispatch(entry, 1)?]);
            let (begin, add) = (both("begin_statistics")?, both("add_sample")?);
            Ok(Part {
                cells,
                buffer,
                begin,
                add,
            })
        };
        Ok(Self {
            parts: (0..cells).step_by(most).map(make).collect::<Result<_>>()?,
            program,
            cells,
            merged: 0,
            open: 0,
            field: None,
            gather: Gather::new(device, lattice)?,
            readback: Readback::default(),
        })
    }

    /// Number of samples.
    pub fn samples(&self) -> u64 {
        self.merged + self.open
    }

    /// Bytes of the buffers.
    pub fn bytes(&self) -> u64 {
        let parts = self.parts.iter().map(|part| part.buffer.size());
        parts
            .chain(self.field.as_ref().map(wgpu::Buffer::size))
            .sum()
    }

    /// Records a sample of the present state.
    ///
    /// # Errors
    /// If the device does not compile the kernel that merges a block.
    pub fn record(
        &mut self,
        device: &wgpu::Device,
        lattice: &mut Lattice,
        pass: &mut wgpu::ComputePass<'_>,
    ) -> Result<()> {
        lattice.close(pass);
        for part in &self.parts {
            let dispatches = match self.samples() {
                0 => &part.begin,
                _ => &part.add,
            };
            dispatches[lattice.parity()].record(pass);
        }
        self.open += 1;
        if self.open == BLOCK {
            for part in &self.parts {
                self.dispatch(device, lattice, part, ("merge_block", 0), &[])?
                    .record(pass);
            }
            self.merged += BLOCK;
            self.open = 0;
        }
        Ok(())
    }

    /// An entry of the kernel on the open block.
    fn dispatch(
        &self,
        device: &wgpu::Device,
        lattice: &Lattice,
        part: &Part,
        (entry, plane): (&'static str, u32),
        others: &[(&str, &wgpu::Buffer)],
    ) -> Result<Dispatch> {
        let content = StatisticsPass {
            plane,
            samples: self.open as f32,
            weight: (self.open as f64 / self.samples() as f64) as f32,
            pad: 0,
        };
        let of_block = uniform(device, "statistics pass", &content);
        let mut buffers = vec![("statistics", &part.buffer), ("statistics_pass", &of_block)];
        buffers.extend(others);
        let dispatch = CellDispatch {
            program: &self.program,
            entry,
            pass: pass_over(&part.cells),
            buffers: &buffers,
            constants: &[],
            invocations: part.cells.end - part.cells.start,
        };
        lattice.cell_dispatch(device, &dispatch)
    }

    /// Reads a statistic of the samples so far on the given cells (indices, x fastest), or on all, lattice units; NaN
    /// before the first sample.
    ///
    /// # Errors
    /// If there is no such component or cell, or the device is lost or does not hold the field.
    pub async fn read(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        lattice: &Lattice,
        statistic: Statistic,
        on: Option<&[u32]>,
    ) -> Result<Vec<f32>> {
        let plane = statistic.plane()?;
        if self.samples() == 0 {
            return Ok(vec![f32::NAN; on.map_or(self.cells, <[u32]>::len)]);
        }
        let field = match self.field.take() {
            Some(field) => field,
            None => zeroed(device, "statistic", 4 * self.cells as u64),
        };
        let mut encoder = device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            for part in &self.parts {
                let entry = ("write_statistic", plane);
                self.dispatch(device, lattice, part, entry, &[("derived", &field)])?
                    .record(&mut pass);
            }
        }
        queue.submit([encoder.finish()]);
        let readback = &mut self.readback;
        let values = match on {
            None => readback.read(device, queue, &field, self.cells).await,
            Some(on) => {
                let gather = &self.gather;
                gather.read(device, queue, readback, &field, on).await
            }
        };
        self.field = Some(field);
        values
    }

    /// Reads all numbers, for a later [`Statistics::restore`].
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn state(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
    ) -> Result<StatisticsState> {
        let mut state = StatisticsState {
            merged: self.merged,
            open: self.open,
            values: Vec::new(),
        };
        if self.samples() == 0 {
            return Ok(state);
        }
        state.values.resize(PLANES * self.cells, 0.0);
        for part in &self.parts {
            let count = part.buffer.size() as usize / 4;
            let read: Vec<f32> = self
                .readback
                .read(device, queue, &part.buffer, count)
                .await?;
            for (plane, values) in state.values.chunks_mut(self.cells).enumerate() {
                for (n, cell) in part.cells.clone().enumerate() {
                    values[cell as usize] = read[place(plane, n)];
                }
            }
        }
        Ok(state)
    }

    /// Checks whether [`Statistics::restore`] accepts a state.
    ///
    /// # Errors
    /// If it belongs to another grid.
    pub fn check(&self, state: &StatisticsState) -> Result<()> {
        let count = match state.merged.saturating_add(state.open) {
            0 => 0,
            _ => PLANES * self.cells,
        };
        match state.values.len() == count && state.open < BLOCK {
            true => Ok(()),
            false => {
                let message = "the saved statistics are of another grid, or damaged";
                Err(Error::argument("restart", message))
            }
        }
    }

    /// Continues from a state.
    ///
    /// # Errors
    /// If it belongs to another grid.
    pub fn restore(&mut self, queue: &wgpu::Queue, state: &StatisticsState) -> Result<()> {
        self.check(state)?;
        (self.merged, self.open) = (state.merged, state.open);
        if state.values.is_empty() {
            return Ok(());
        }
        for part in &self.parts {
            let mut own = vec![0.0; part.buffer.size() as usize / 4];
            for (plane, values) in state.values.chunks(self.cells).enumerate() {
                for (n, cell) in part.cells.clone().enumerate() {
                    own[place(plane, n)] = values[cell as usize];
                }
            }
            queue.write_buffer(&part.buffer, 0, bytemuck::cast_slice(&own));
        }
        Ok(())
    }
}

/// The pass over all cells in order.
fn pass_over(cells: &Range<u32>) -> CellPass {
    CellPass {
        first: cells.start,
        end: cells.end,
        ..CellPass::default()
    }
}
