//! Means and covariances over time of density and velocity, on the device.

use super::{
    Bindings, CellPass, Lattice, Observer, STATISTICS_PLANES,
    cell_kernels::{CellDispatch, uniform},
    fluid::Dispatch,
    gather::Gather,
    memory::{memory, statistics_bindings},
    program,
    spread::{STATISTICS_NAME, planes},
};
use crate::{
    Error, Result,
    gpu::{buffers::zeroed, kernel::submit_pass, link::Program, readback::Readback},
};
use bytemuck::{Pod, Zeroable};

/// Number of samples per block.
const BLOCK: u64 = 256;
/// Numbers per cell.
const PLANES: usize = STATISTICS_PLANES as usize;

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

/// Where samples come from.
#[derive(Debug)]
enum Source {
    /// The kernels of the lattice, which add the state before a step.
    Steps {
        /// Kernels of the first sample, after an even and after an odd number of steps.
        begin: [Dispatch; 2],
    },
    /// The fields of an observer.
    Observer {
        /// Kernel of the first sample.
        begin: Dispatch,
        /// Kernel of the others.
        add: Dispatch,
    },
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
/// let mut statistics = Statistics::new(&device, &mut lattice)?;
///
/// let mut encoder = device.create_command_encoder(&Default::default());
/// {
///     let mut pass = encoder.begin_compute_pass(&Default::default());
///     // An odd number of steps between samples: what alternates from step to step then averages out.
///     for step in 0..50 {
///         if step % 5 == 0 {
///             statistics.record(&device, &mut lattice, &mut pass)?;
///         }
///         lattice.record(&mut pass);
///     }
/// }
/// queue.submit([encoder.finish()]);
/// assert_eq!(statistics.samples(), 10);
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Statistics {
    /// The sums, by their names in WGSL.
    planes: Vec<(String, wgpu::Buffer)>,
    source: Source,
    program: Program,
    merged: u64,
    open: u64,
    /// Created when first read.
    field: Option<wgpu::Buffer>,
    gather: Gather,
    readback: Readback,
}

impl Statistics {
    /// Statistics that the steps of `lattice` add to: a sample costs as much as accessing its sums, and nothing is read twice. In
    /// cells with solid the velocity is that in the middle of the step. A lattice has at most one of these.
    ///
    /// # Errors
    /// [`Error::Limit`] if a kernel of the lattice cannot also bind the sums; [`Statistics::of_observer`] needs fewer bindings.
    /// [`Error::Argument`] if the lattice has statistics already.
    pub fn new(device: &wgpu::Device, lattice: &mut Lattice) -> Result<Self> {
        if lattice.streams.has_statistics() {
            let message = "this lattice has statistics over time already; read those";
            return Err(Error::argument("statistics", message));
        }
        let (setup, grid, limits) = (&lattice.setup, &lattice.grid, device.limits());
        let others = memory(setup, grid, &limits)?.most_bindings;
        let count = statistics_bindings(setup, grid, &limits, others)?;
        let planes = make_planes(device, lattice, count);
        let program = sums_program(lattice, count).slot("sample", "sample_populations");
        let begin = |odd| {
            let named = planes.iter().map(|(name, buffer)| (name.as_str(), buffer));
            let buffers: Vec<_> = named.collect();
            cell_dispatch(
                device,
                lattice,
                &program,
                ("begin_statistics", odd),
                &buffers,
            )
        };
        let begin = [begin(0)?, begin(1)?];
        let bindings = Bindings {
            statistics: count,
            ..lattice.bindings
        };
        let of_lattice = (&lattice.setup, &lattice.grid, &lattice.buffers);
        let streams = &mut lattice.streams;
        streams.add_statistics(device, of_lattice, bindings, planes.clone())?;
        let source = Source::Steps { begin };
        Self::of_parts(device, lattice, (planes, program, source))
    }

    /// Statistics of the fields of `observer`: call [`Observer::record`] before each [`Statistics::record`].
    ///
    /// # Errors
    /// [`Error::Limit`] if the device cannot bind the sums.
    pub fn of_observer(
        device: &wgpu::Device,
        lattice: &Lattice,
        observer: &Observer,
    ) -> Result<Self> {
        // Besides the fields of the observer, or the field that is read.
        let count = statistics_bindings(&lattice.setup, &lattice.grid, &device.limits(), 4)?;
        let planes = make_planes(device, lattice, count);
        let program = sums_program(lattice, count).slot("sample", "sample_observed");
        let [x, y, z] = observer.velocity();
        let mut buffers = vec![
            ("density", observer.density()),
            ("velocity_x", x),
            ("velocity_y", y),
            ("velocity_z", z),
        ];
        buffers.extend(planes.iter().map(|(name, buffer)| (name.as_str(), buffer)));
        let dispatch = |entry| cell_dispatch(device, lattice, &program, (entry, 0), &buffers);
        let source = Source::Observer {
            begin: dispatch("begin_statistics")?,
            add: dispatch("add_observed")?,
        };
        Self::of_parts(device, lattice, (planes, program, source))
    }

    fn of_parts(
        device: &wgpu::Device,
        lattice: &Lattice,
        (planes, program, source): (Vec<(String, wgpu::Buffer)>, Program, Source),
    ) -> Result<Self> {
        Ok(Self {
            planes,
            source,
            program,
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
        let planes = self.planes.iter().map(|(_, buffer)| buffer.size());
        planes
            .chain(self.field.as_ref().map(wgpu::Buffer::size))
            .sum()
    }

    /// Whether samples are read from an [`Observer`].
    pub fn is_of_observer(&self) -> bool {
        matches!(self.source, Source::Observer { .. })
    }

    /// Records a sample of the present state: at once from the fields of an observer; otherwise the next step adds it, which
    /// must be recorded before statistics are read.
    ///
    /// # Errors
    /// If the device does not compile the kernel that merges a block, or the state is the last sample already.
    pub fn record(
        &mut self,
        device: &wgpu::Device,
        lattice: &mut Lattice,
        pass: &mut wgpu::ComputePass<'_>,
    ) -> Result<()> {
        self.check_complete(lattice)?;
        if self.open == BLOCK {
            self.dispatch(device, lattice, ("merge_block", 0), &[])?
                .record(pass);
            self.merged += BLOCK;
            self.open = 0;
        }
        let first = self.samples() == 0;
        match &self.source {
            Source::Steps { begin } => {
                if first {
                    lattice.close(pass);
                    begin[lattice.parity()].record(pass);
                }
                lattice.streams.samples = true;
            }
            Source::Observer { begin, .. } if first => begin.record(pass),
            Source::Observer { add, .. } => add.record(pass),
        }
        self.open += 1;
        Ok(())
    }

    /// Checks that the step that adds the last sample has been recorded.
    fn check_complete(&self, lattice: &Lattice) -> Result<()> {
        if self.is_of_observer() || !lattice.streams.samples {
            return Ok(());
        }
        let message = "the step that adds the last sample has not been recorded; record it first";
        Err(Error::argument("statistics", message))
    }

    /// An entry of the kernel on the open block.
    fn dispatch(
        &self,
        device: &wgpu::Device,
        lattice: &Lattice,
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
        let mut buffers = vec![("statistics_pass", &of_block)];
        let planes = self.planes.iter();
        buffers.extend(planes.map(|(name, buffer)| (name.as_str(), buffer)));
        buffers.extend(others);
        cell_dispatch(device, lattice, &self.program, (entry, 0), &buffers)
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
        self.check_complete(lattice)?;
        let cells = lattice.grid.cell_count();
        if self.samples() == 0 {
            return Ok(vec![f32::NAN; on.map_or(cells, <[u32]>::len)]);
        }
        let field = match self.field.take() {
            Some(field) => field,
            None => zeroed(device, "statistic", 4 * cells as u64),
        };
        let entry = ("write_statistic", plane);
        let dispatch = self.dispatch(device, lattice, entry, &[("derived", &field)])?;
        submit_pass(device, queue, |pass| dispatch.record(pass));
        let readback = &mut self.readback;
        let values = match on {
            None => readback.read(device, queue, &field, cells).await,
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
    /// If the device is lost, or a step that adds a sample has not been recorded.
    pub async fn state(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        lattice: &Lattice,
    ) -> Result<StatisticsState> {
        self.check_complete(lattice)?;
        let mut state = StatisticsState {
            merged: self.merged,
            open: self.open,
            values: Vec::new(),
        };
        if self.samples() == 0 {
            return Ok(state);
        }
        let grid = &lattice.grid;
        let scalars = grid.scalar_count() as usize;
        for (_, buffer) in &self.planes {
            let count = buffer.size() as usize / 4;
            let read: Vec<f32> = self.readback.read(device, queue, buffer, count).await?;
            for plane in read.chunks_exact(scalars) {
                let scalars = grid.domain().map(|cell| grid.scalar_of(cell));
                state.values.extend(scalars.map(|at| plane[at as usize]));
            }
        }
        Ok(state)
    }

    /// Checks whether [`Statistics::restore`] accepts a state.
    ///
    /// # Errors
    /// If it belongs to another grid.
    pub fn check(&self, lattice: &Lattice, state: &StatisticsState) -> Result<()> {
        let count = match state.merged.saturating_add(state.open) {
            0 => 0,
            _ => PLANES * lattice.grid.cell_count(),
        };
        match state.values.len() == count && state.open <= BLOCK {
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
    pub fn restore(
        &mut self,
        queue: &wgpu::Queue,
        lattice: &mut Lattice,
        state: &StatisticsState,
    ) -> Result<()> {
        self.check(lattice, state)?;
        (self.merged, self.open) = (state.merged, state.open);
        if !self.is_of_observer() {
            lattice.streams.samples = false;
        }
        if state.values.is_empty() {
            return Ok(());
        }
        let grid = &lattice.grid;
        let scalars = grid.scalar_count() as usize;
        let mut values = state.values.chunks(grid.cell_count());
        for (_, buffer) in &self.planes {
            let mut own = vec![0.0; buffer.size() as usize / 4];
            for (plane, values) in own.chunks_exact_mut(scalars).zip(&mut values) {
                for (cell, value) in grid.domain().zip(values) {
                    plane[grid.scalar_of(cell) as usize] = *value;
                }
            }
            queue.write_buffer(buffer, 0, bytemuck::cast_slice(&own));
        }
        Ok(())
    }
}

/// The buffers of the sums, over so many bindings.
fn make_planes(
    device: &wgpu::Device,
    lattice: &Lattice,
    count: u32,
) -> Vec<(String, wgpu::Buffer)> {
    let plane = 4 * u64::from(lattice.grid.scalar_count());
    let planes = planes(STATISTICS_PLANES, count).into_iter().enumerate();
    planes
        .map(|(n, own)| {
            let buffer = zeroed(device, "statistics", own.len() as u64 * plane);
            (format!("{STATISTICS_NAME}_{n}"), buffer)
        })
        .collect()
}

/// The kernels of single cells on the sums.
fn sums_program(lattice: &Lattice, count: u32) -> Program {
    let bindings = Bindings {
        statistics: count,
        ..lattice.bindings
    };
    program::single_cells(&lattice.setup, bindings, "statistics")
}

/// A dispatch over all cells, in steps of the given parity.
fn cell_dispatch(
    device: &wgpu::Device,
    lattice: &Lattice,
    program: &Program,
    (entry, odd): (&'static str, u32),
    buffers: &[(&str, &wgpu::Buffer)],
) -> Result<Dispatch> {
    let dispatch = CellDispatch {
        program,
        entry,
        pass: CellPass {
            odd,
            ..CellPass::default()
        },
        buffers,
        constants: &[],
        invocations: lattice.grid.scalar_count(),
    };
    lattice.cell_dispatch(device, &dispatch)
}
