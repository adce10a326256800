//! The fluid on a device: its buffers, its kernels, and the recording of steps.

use super::{
    Bindings, Geometry, Grid, Setup,
    block_friction::BlockPasses,
    buffers::{Buffers, make_buffers},
    cell_kernels::CellKernels,
    spread::PSM_NAMES,
    streams::Streams,
};
use crate::{Error, Result, gpu::kernel::Kernel};
use std::sync::Arc;

/// A dispatch that is ready to be recorded.
#[derive(Debug)]
pub(super) struct Dispatch {
    kernel: Arc<Kernel>,
    bind: wgpu::BindGroup,
    groups: u32,
}

impl Dispatch {
    /// A dispatch of `groups` workgroups of a kernel with its buffers.
    pub(super) fn new(kernel: Arc<Kernel>, bind: wgpu::BindGroup, groups: u32) -> Self {
        Self {
            kernel,
            bind,
            groups,
        }
    }

    /// Records it.
    pub(super) fn record(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.kernel.record(pass, &self.bind, self.groups);
    }
}

/// A D3Q27 lattice Boltzmann fluid.
///
/// It owns buffers and pipelines; the caller owns device, queue and encoder. A step is recorded
/// by [`Lattice::record`]; nothing is read back unless requested.
#[derive(Debug)]
pub struct Lattice {
    pub(super) setup: Setup,
    pub(super) grid: Grid,
    pub(super) geometry: Geometry,
    pub(super) bindings: Bindings,
    pub(super) buffers: Buffers,
    /// Boundary passes of even and odd steps.
    boundary: [Vec<Dispatch>; 2],
    /// Data of the wall model on blocks.
    pub(super) of_blocks: BlockPasses,
    /// Whether the faces of blocks have been found at their present positions.
    faces_found: bool,
    /// Kernels for single cells.
    pub(super) cells: CellKernels,
    /// Collision and streaming.
    pub(super) streams: Streams,
    /// Number of steps recorded.
    pub(super) step: u64,
    /// Whether the boundary passes of the coming step have been recorded.
    pub(super) closed: bool,
    /// Changes with every change of the state.
    pub(super) revision: u64,
}

impl Lattice {
    /// Creates buffers and pipelines; the populations are those of rest at ρ = 1 until an initial
    /// state is set.
    ///
    /// # Errors
    /// [`Error::Argument`] for a setup that contradicts itself, [`Error::Limit`] if the device cannot
    /// hold it.
    pub fn new(device: &wgpu::Device, setup: Setup) -> Result<Self> {
        setup.check()?;
        if !device.features().contains(setup.features()) {
            return Err(Error::Device(
                "`Setup::wide` asks for 64-bit words, which this device was not opened with; request \
                 `Features::SHADER_INT64`, or leave it false"
                    .into(),
            ));
        }
        let grid = Grid::new(&setup)?;
        let memory = super::memory(&setup, &grid, &device.limits())?;
        let geometry = Geometry::new(&setup, &grid);
        let buffers = make_buffers(device, &setup, &grid, &geometry, memory.bindings)?;
        let streams = Streams::new(device, &setup, &grid, &geometry, memory.bindings, &buffers)?;
        let mut lattice = Self {
            bindings: memory.bindings,
            boundary: [Vec::new(), Vec::new()],
            of_blocks: BlockPasses::default(),
            faces_found: false,
            cells: CellKernels::default(),
            streams,
            setup,
            grid,
            geometry,
            buffers,
            step: 0,
            closed: false,
            revision: 0,
        };
        for odd in [0, 1] {
            lattice.boundary[odd as usize] = lattice.boundary_passes(device, odd)?;
        }
        lattice.of_blocks = lattice.block_passes(device)?;
        Ok(lattice)
    }

    /// Its setup.
    pub fn setup(&self) -> &Setup {
        &self.setup
    }

    /// Its layout in memory.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Walls, open faces and bricks of its cells.
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// The buffers that hold the populations, by direction: the layout is that of
    /// `kernels/lattice/stream.wgsl`, and its parity that of [`Lattice::step`].
    pub fn population_buffers(&self) -> &[wgpu::Buffer] {
        &self.buffers.populations
    }

    /// Velocities of moving walls and velocity faces in the last step, synthetic turbulence included, lattice units: for each cell of
    /// [`Geometry::moving`] those of its faces normal to x, y, z, three components each. `None` without moving walls and velocity faces.
    pub fn wall_velocity_buffer(&self) -> Option<&wgpu::Buffer> {
        self.buffers.wall_velocity.as_ref()
    }

    /// Steps recorded since the start of the run.
    pub fn step(&self) -> u64 {
        self.step
    }

    /// The kernels of an even or odd step in their order, each with its workgroups.
    pub fn kernels(&self, odd: bool) -> impl Iterator<Item = (&Kernel, u32)> {
        let parity = usize::from(odd);
        let boundary = self.boundary[parity].iter();
        boundary
            .map(|dispatch| (&*dispatch.kernel, dispatch.groups))
            .chain(self.streams.kernels(parity))
    }

    /// The kernels of a step that adds a sample to the statistics over time, in place of those of collision and streaming, each
    /// with its workgroups; none without such statistics.
    pub fn sampling_kernels(&self, odd: bool) -> impl Iterator<Item = (&Kernel, u32)> {
        self.streams.sampling_kernels(usize::from(odd))
    }

    /// Records one step into the caller's pass.
    pub fn record(&mut self, pass: &mut wgpu::ComputePass<'_>) {
        self.record_psm(pass);
        self.record_rest(pass);
    }

    /// Records the boundaries of the coming step alone. [`Lattice::record_psm`] does so unless it has been done.
    pub fn record_boundaries(&mut self, pass: &mut wgpu::ComputePass<'_>) {
        self.close(pass);
    }

    /// Records the first part of a step: the boundaries, and the bricks that blocks reach. The
    /// loads on the blocks are known after it.
    pub fn record_psm(&mut self, pass: &mut wgpu::ComputePass<'_>) {
        self.close(pass);
        let faces = (!self.faces_found).then_some(&self.of_blocks.faces);
        let friction = &self.of_blocks.friction[self.parity()];
        for dispatch in faces.into_iter().flatten().chain(friction) {
            dispatch.record(pass);
        }
        self.faces_found = true;
        self.streams.record(pass, self.parity(), true);
        for dispatch in &self.of_blocks.sloping[self.parity()] {
            dispatch.record(pass);
        }
    }

    /// Records the rest of a step after [`Lattice::record_psm`]: all other bricks. Streaming is in
    /// place and every population has one owner a step, so that the bits do not depend on this split.
    pub fn record_rest(&mut self, pass: &mut wgpu::ComputePass<'_>) {
        self.streams.record(pass, self.parity(), false);
        for dispatch in &self.of_blocks.end {
            dispatch.record(pass);
        }
        self.step += 1;
        self.revision += 1;
        self.closed = false;
        self.streams.samples = false;
    }

    /// Sets the bricks, numbered as in [`Grid::bricks`] with x fastest, that the kernel for blocks computes;
    /// initially none. Only of a setup with a `solid_operator`.
    ///
    /// # Errors
    /// If the setup has no blocks, or a brick does not exist, is solid or is listed twice.
    pub fn set_psm_bricks(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        bricks: &[u32],
    ) -> Result<()> {
        if self.setup.solid_operator.is_none() {
            let message = "the setup has no solid operator, so that no block may be in the fluid";
            return Err(Error::argument("solid_operator", message));
        }
        let Self {
            streams,
            setup,
            geometry,
            buffers,
            ..
        } = self;
        if let Some(bad) = bricks.iter().find(|&&brick| !geometry.runs(brick)) {
            let message = format!("brick {bad} has no fluid cell, or does not exist");
            return Err(Error::argument("bricks", message));
        }
        // Two workgroups would write to the same brick.
        let mut ascending = bricks.to_vec();
        ascending.sort_unstable();
        if let Some(twice) = ascending.windows(2).find(|pair| pair[0] == pair[1]) {
            let bad = twice[0];
            let message = format!("brick {bad} is listed twice; list each brick once");
            return Err(Error::argument("bricks", message));
        }
        if !streams.set(device, queue, (setup, geometry, buffers), bricks)? {
            return Ok(());
        }
        self.write_psm_slots(queue, bricks);
        // The buffers of the planes may have changed.
        self.of_blocks = self.block_passes(device)?;
        self.blocks_have_moved();
        Ok(())
    }

    /// Makes the wall model search the faces of blocks again in the next step. Call it after writing solid fractions to
    /// [`Lattice::psm_planes`]; [`Lattice::set_psm_bricks`] calls it for changed bricks.
    pub fn blocks_have_moved(&mut self) {
        self.faces_found = false;
        self.revision += 1;
    }

    /// The planes of partially saturated cells, of the bricks that blocks reach, in the order of
    /// [`Lattice::set_psm_bricks`], as `kernels/psm/psm_planes.wgsl` lists them: each binding with its name in WGSL. It has
    /// [`super::PSM_PLANES`] over their number, rounded up, for one brick after the other. Other buffers after that
    /// call, if they had to grow; none without a solid operator.
    pub fn psm_planes(&self) -> impl Iterator<Item = (&str, &wgpu::Buffer)> {
        PSM_NAMES.into_iter().zip(self.streams.psm_planes())
    }

    /// Over how many bindings its fields are spread.
    pub fn bindings(&self) -> Bindings {
        self.bindings
    }

    /// The buffer with the number and the list of the bricks that blocks reach, and that number; `None` without blocks.
    pub(super) fn psm_bricks(&self) -> Option<(&wgpu::Buffer, u32)> {
        self.streams.psm_bricks()
    }

    /// Records the boundary passes of the coming step, unless that is done: after it the
    /// populations of every fluid cell are complete.
    pub(super) fn close(&mut self, pass: &mut wgpu::ComputePass<'_>) {
        if !self.closed {
            for dispatch in &self.boundary[self.parity()] {
                dispatch.record(pass);
            }
            self.closed = true;
        }
    }

    pub(super) fn parity(&self) -> usize {
        (self.step % 2) as usize
    }
}

/// The axes of a face normal to `axis`, lower one first.
pub fn in_plane(axis: usize) -> (usize, usize) {
    match axis {
        0 => (1, 2),
        1 => (0, 2),
        _ => (0, 1),
    }
}

/// The name of a face in errors, by its axis, 0 to 2, and side, 0 or 1.
pub fn face_name(axis: usize, side: usize) -> String {
    let axis = ["x", "y", "z"].get(axis).unwrap_or(&"?");
    format!("faces.{axis}_{}", if side == 0 { "min" } else { "max" })
}
