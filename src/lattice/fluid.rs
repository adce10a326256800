//! The fluid on a device: its buffers, its kernels, and what a step records.

use super::{
    Bindings, Face, Force, Geometry, Grid, OpenFace, Setup,
    cell_kernels::CellKernels,
    force::force_words,
    geometry::{FaceCell, MovingCell},
    populations,
    spread::{PSM_NAMES, planes},
    streams::Streams,
    surface::Surface,
    synthetic_turbulence::Inlet,
    wall_model::WallPart,
};
use crate::{
    Error, Result,
    gpu::{filled::filled, kernel::Kernel},
};
use std::sync::Arc;

/// A dispatch that is ready to be recorded.
#[derive(Debug)]
pub(super) struct Dispatch {
    kernel: Arc<Kernel>,
    bind: wgpu::BindGroup,
    groups: u32,
}

impl Dispatch {
    /// `groups` workgroups of a kernel with its buffers.
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
/// It owns buffers and pipelines; device, queue and encoder are the caller's. A step is recorded
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
    /// Those that find walls with blocks near them.
    marks: Vec<Dispatch>,
    /// Kernels for single cells.
    pub(super) cells: CellKernels,
    /// Collision and streaming.
    pub(super) streams: Streams,
    /// Steps recorded.
    pub(super) step: u64,
    /// Whether the boundary passes of the coming step have been recorded.
    pub(super) closed: bool,
}

/// The device memory of a fluid; what a setup does not use is not there.
#[derive(Debug)]
pub(super) struct Buffers {
    pub(super) populations: Vec<wgpu::Buffer>,
    pub(super) names: Vec<String>,
    /// Velocity of the last and the coming step, exchanged each step.
    pub(super) velocity: Option<[Vec<wgpu::Buffer>; 2]>,
    pub(super) flags: Option<wgpu::Buffer>,
    pub(super) force: Vec<wgpu::Buffer>,
    /// The force of all cells, if they have one force.
    pub(super) uniform_force: Option<wgpu::Buffer>,
    pub(super) guard: Option<wgpu::Buffer>,
    pub(super) wall_velocity: Option<wgpu::Buffer>,
    /// The turbulence of velocity faces.
    pub(super) inlets: Vec<Inlet>,
    /// Least eddy viscosity of each cell, by the wall model.
    pub(super) near_wall_viscosity: Option<wgpu::Buffer>,
    /// The walls of the model.
    pub(super) walls: Vec<WallPart>,
    /// Of each brick its place among those that blocks reach, from 1, for the wall model.
    pub(super) psm_slots: Option<wgpu::Buffer>,
    /// Cells that solids at rest fill in part.
    pub(super) surface: Option<Surface>,
    /// Cells of each open face, and what they carry from step to step.
    pub(super) open_faces: Vec<(wgpu::Buffer, wgpu::Buffer)>,
    /// What its passes take, an [`OpenFace`].
    pub(super) open_face_uniforms: Vec<wgpu::Buffer>,
}

/// Names of the bindings of fields of vectors.
const BEFORE: [&str; 3] = [
    "velocity_before_0",
    "velocity_before_1",
    "velocity_before_2",
];
const AFTER: [&str; 3] = ["velocity_after_0", "velocity_after_1", "velocity_after_2"];
const FORCE: [&str; 3] = ["force_field_0", "force_field_1", "force_field_2"];

impl Buffers {
    /// All by their names in WGSL, for a step of the given parity.
    pub(super) fn named(&self, odd: bool) -> Vec<(&str, &wgpu::Buffer)> {
        let names = self.names.iter().map(String::as_str);
        let mut all: Vec<_> = names.zip(&self.populations).collect();
        if let Some(velocity) = &self.velocity {
            all.extend(BEFORE.into_iter().zip(&velocity[usize::from(odd)]));
            all.extend(AFTER.into_iter().zip(&velocity[usize::from(!odd)]));
        }
        all.extend(FORCE.into_iter().zip(&self.force));
        let optional = [
            ("flags", &self.flags),
            ("uniform_force", &self.uniform_force),
            ("guard_state", &self.guard),
            ("wall_velocity", &self.wall_velocity),
            ("near_wall_viscosity", &self.near_wall_viscosity),
            ("psm_slots", &self.psm_slots),
        ];
        if let Some(surface) = &self.surface {
            all.extend([
                ("surface_slots", &surface.slots),
                ("surface_fractions", &surface.fractions),
            ]);
        }
        all.extend(
            optional
                .into_iter()
                .filter_map(|(n, b)| Some((n, b.as_ref()?))),
        );
        all
    }
}

/// The guard's memory before the first step: no step counted, no cell at fault.
pub(super) const GUARD_START: [u32; 4] = [0, 0, u32::MAX, u32::MAX];

impl Lattice {
    /// Makes buffers and pipelines; the populations are those of rest at ρ = 1 until an initial
    /// state is given.
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
        let buffers = make_buffers(device, &setup, &grid, &geometry, memory.bindings);
        let streams = Streams::new(device, &setup, &grid, &geometry, memory.bindings, &buffers)?;
        let mut lattice = Self {
            bindings: memory.bindings,
            boundary: [Vec::new(), Vec::new()],
            marks: Vec::new(),
            cells: CellKernels::default(),
            streams,
            setup,
            grid,
            geometry,
            buffers,
            step: 0,
            closed: false,
        };
        for odd in [0, 1] {
            lattice.boundary[odd as usize] = lattice.boundary_passes(device, odd)?;
        }
        lattice.marks = lattice.mark_passes(device)?;
        Ok(lattice)
    }

    /// What it was made from.
    pub fn setup(&self) -> &Setup {
        &self.setup
    }

    /// How it lies in memory.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// What surrounds its cells.
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// The buffers that hold the populations, by direction: the layout is that of
    /// `kernels/lattice/stream.wgsl`, and its parity that of [`Lattice::step`].
    pub fn population_buffers(&self) -> &[wgpu::Buffer] {
        &self.buffers.populations
    }

    /// Velocities of moving walls and velocity faces in the last step, synthetic turbulence included, lattice units: for each cell of
    /// [`Geometry::moving`] those of its faces normal to x, y, z, three components each. None where nothing moves.
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
        for dispatch in &self.marks {
            dispatch.record(pass);
        }
        self.streams.record(pass, self.parity(), true);
    }

    /// Records the rest of a step after [`Lattice::record_psm`]: all other bricks. Streaming is in
    /// place and every population has one owner a step, so that the bits do not depend on this split.
    pub fn record_rest(&mut self, pass: &mut wgpu::ComputePass<'_>) {
        self.streams.record(pass, self.parity(), false);
        self.step += 1;
        self.closed = false;
    }

    /// Has these bricks, numbered as in [`Grid::bricks`] with x fastest, run by the kernel for blocks;
    /// none are at the start. Only of a setup with a `solid_operator`.
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
        // Two workgroups would share a brick and write over each other.
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
        // The planes may be other buffers.
        self.marks = self.mark_passes(device)?;
        Ok(())
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

    /// The list of the bricks that blocks reach, after their number, and that; none where there are none.
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

/// A read-only storage buffer with this content.
pub(super) fn storage(device: &wgpu::Device, label: &str, contents: &[u8]) -> wgpu::Buffer {
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
    filled(device, label, contents, usage)
}

/// A storage buffer that can be read back.
pub(super) fn result_buffer(device: &wgpu::Device, label: &str, bytes: u64) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes,
        usage: wgpu::BufferUsages::STORAGE
            | wgpu::BufferUsages::COPY_DST
            | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    })
}

fn make_buffers(
    device: &wgpu::Device,
    setup: &Setup,
    grid: &Grid,
    geometry: &Geometry,
    bindings: Bindings,
) -> Buffers {
    let scalars = u64::from(grid.scalar_count());
    let word = super::bytes_a_population(setup.storage);
    let spread = |label, count, bindings, bytes| {
        let planes = planes(count, bindings).into_iter();
        planes
            .map(|own| result_buffer(device, label, own.len() as u64 * bytes))
            .collect::<Vec<_>>()
    };
    let populations = spread(
        "populations",
        populations::Q,
        bindings.populations,
        scalars * word,
    );
    let names = (0..populations.len())
        .map(|b| format!("populations_{b}"))
        .collect();
    let velocity = || spread("velocity", 3, bindings.vectors, 4 * scalars);
    let force = match &setup.force {
        Force::Field(field) => vectors(grid, bindings.vectors, |n| field[n])
            .map(|values| storage(device, "force field", bytemuck::cast_slice(&values)))
            .collect(),
        _ => Vec::new(),
    };
    let uniform_force = match setup.force {
        Force::Constant(force) => {
            let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
            let content = force_words(force);
            Some(filled(
                device,
                "force",
                bytemuck::cast_slice(&content),
                usage,
            ))
        }
        _ => None,
    };
    let moving = wall_velocities(setup, grid, &geometry.moving);
    let list = |label, values: &[u32]| {
        (!values.is_empty()).then(|| storage(device, label, bytemuck::cast_slice(values)))
    };
    let open_faces = geometry.open.iter().map(|(_, _, cells)| {
        // A face that solids close entirely keeps one entry that no direction enters.
        let none = [FaceCell::default()];
        let cells = if cells.is_empty() { &none[..] } else { cells };
        let carried = result_buffer(device, "carried", 108 * cells.len() as u64);
        (
            storage(device, "face cells", bytemuck::cast_slice(cells)),
            carried,
        )
    });
    Buffers {
        populations,
        open_faces: open_faces.collect(),
        open_face_uniforms: geometry
            .open
            .iter()
            .map(|(axis, side, _)| {
                let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
                let content = OpenFace::of(setup, grid, *axis, *side);
                filled(device, "open face", bytemuck::bytes_of(&content), usage)
            })
            .collect(),
        names,
        velocity: setup.wale.map(|_| [velocity(), velocity()]),
        flags: list("flags", &geometry.flags),
        force,
        uniform_force,
        guard: (setup.max_speed > 0.0).then(|| {
            let usage = wgpu::BufferUsages::STORAGE
                | wgpu::BufferUsages::COPY_DST
                | wgpu::BufferUsages::COPY_SRC;
            filled(device, "guard", bytemuck::cast_slice(&GUARD_START), usage)
        }),
        wall_velocity: (!moving.is_empty()).then(|| {
            let usage = wgpu::BufferUsages::STORAGE
                | wgpu::BufferUsages::COPY_DST
                | wgpu::BufferUsages::COPY_SRC;
            filled(
                device,
                "wall velocity",
                bytemuck::cast_slice(&moving),
                usage,
            )
        }),
        inlets: Inlet::all(device, setup, grid, &geometry.moving),
        // New buffers hold zeros.
        near_wall_viscosity: setup
            .wall_model
            .map(|_| result_buffer(device, "near-wall viscosity", 4 * scalars)),
        surface: Surface::new(device, setup, grid),
        walls: WallPart::all(device, setup, &geometry.walls),
        psm_slots: (setup.wall_model.is_some() && setup.solid_operator.is_some()).then(|| {
            let bricks: u32 = grid.bricks().iter().product();
            result_buffer(device, "slots of bricks", 4 * u64::from(bricks))
        }),
    }
}

/// What each binding of a field of vectors holds; `of` gives the vector of a domain cell.
pub(super) fn vectors(
    grid: &Grid,
    bindings: u32,
    of: impl Fn(usize) -> [f32; 3],
) -> impl Iterator<Item = Vec<f32>> {
    let scalars = grid.scalar_count() as usize;
    planes(3, bindings).into_iter().map(move |own| {
        let mut values = vec![0f32; own.len() * scalars];
        for (n, cell) in grid.domain().enumerate() {
            let (at, vector) = (grid.scalar_of(cell) as usize, of(n));
            for (plane, a) in own.clone().enumerate() {
                values[plane * scalars + at] = vector[a as usize];
            }
        }
        values
    })
}

/// Velocities of the moving faces of each cell: normal to x, y, z, three components each.
pub(super) fn wall_velocities(
    setup: &Setup,
    grid: &Grid,
    moving: &[MovingCell],
) -> Vec<[[f32; 3]; 3]> {
    let of = |cell: &MovingCell, axis: usize| {
        let at = grid.padded_cell(cell.cell);
        let Some(side) = moving_side(cell, axis) else {
            return [0.0; 3];
        };
        let (a, b) = in_plane(axis);
        match &setup.faces[axis][side] {
            Face::Wall(velocity) => velocity.map(|v| v as f32),
            Face::Velocity(list) => list[(at[a] + grid.cells[a] * at[b]) as usize],
            _ => [0.0; 3],
        }
    };
    moving
        .iter()
        .map(|cell| [0, 1, 2].map(|axis| of(cell, axis)))
        .collect()
}

/// The side of the moving face of a cell that is normal to `axis`. Both sides of a domain one cell thick are its own faces; the lower one
/// decides.
pub(super) fn moving_side(cell: &MovingCell, axis: usize) -> Option<usize> {
    let through = cell.through[axis];
    let low = (1..27).any(|q| through & (1 << q) != 0 && super::geometry::C[q][axis] < 0);
    (through != 0).then_some(usize::from(!low))
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
