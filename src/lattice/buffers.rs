//! The buffers of a fluid.

use super::{
    Bindings, Face, Force, Geometry, Grid, OpenFace, Setup,
    fluid::in_plane,
    force::force_words,
    geometry::{FaceCell, MovingCell},
    populations,
    spread::planes,
    surface::Surface,
    surface_friction::SurfacePart,
    synthetic_turbulence::Inlet,
    wall_model::WallPart,
};
use crate::{
    Result,
    gpu::buffers::{filled, zeroed},
};
use std::borrow::Cow;

/// The device memory of a fluid; what a setup does not use is not there.
#[derive(Debug)]
pub(super) struct Buffers {
    pub(super) populations: Vec<wgpu::Buffer>,
    pub(super) names: Vec<String>,
    /// Velocity of the last and the coming step, exchanged each step; one field if the eddy viscosity is evaluated every
    /// second step; empty without eddy viscosity.
    pub(super) velocity: Vec<Vec<wgpu::Buffer>>,
    /// Eddy viscosity of the last even step for the odd one after it.
    pub(super) eddy_viscosity: Option<wgpu::Buffer>,
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
    /// Faces of these with a wall model.
    pub(super) sloping_surface: Option<SurfacePart>,
    pub(super) open: OpenBuffers,
}

/// The buffers of pressure and outflow faces.
#[derive(Debug)]
pub(super) struct OpenBuffers {
    /// An [`OpenFace`] for each face of the domain.
    pub faces: wgpu::Buffer,
    /// Cells of pressure faces, or a default one.
    pub pressure: wgpu::Buffer,
    /// Cells of outflow faces likewise.
    pub outflow: wgpu::Buffer,
    /// What the cells of outflow faces carry from step to step, 27 numbers each.
    pub outflow_state: wgpu::Buffer,
}

impl OpenBuffers {
    fn new(device: &wgpu::Device, setup: &Setup, grid: &Grid, geometry: &Geometry) -> Self {
        let faces: [OpenFace; 6] =
            std::array::from_fn(|face| OpenFace::of(setup, grid, face / 2, face % 2));
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let list = |cells: &[FaceCell]| {
            let none = [FaceCell::default()];
            let cells = if cells.is_empty() { &none } else { cells };
            storage(device, "face cells", bytemuck::cast_slice(cells))
        };
        let carrying = geometry.outflow.len().max(1) as u64;
        Self {
            faces: filled(device, "open faces", bytemuck::cast_slice(&faces), usage),
            pressure: list(&geometry.pressure),
            outflow: list(&geometry.outflow),
            outflow_state: zeroed(device, "outflow_state", 108 * carrying),
        }
    }
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
    /// The velocity that a step of the given parity reads.
    pub(super) fn velocity_before(&self, odd: bool) -> Option<&Vec<wgpu::Buffer>> {
        let fields = self.velocity.len().max(1);
        self.velocity.get(usize::from(odd) % fields)
    }

    /// All by their names in WGSL, for a step of the given parity.
    pub(super) fn named(&self, odd: bool) -> Vec<(&str, &wgpu::Buffer)> {
        let names = self.names.iter().map(String::as_str);
        let mut all: Vec<_> = names.zip(&self.populations).collect();
        if let Some(before) = self.velocity_before(odd) {
            all.extend(BEFORE.into_iter().zip(before));
        }
        if let [_, _] = &self.velocity[..] {
            all.extend(AFTER.into_iter().zip(&self.velocity[usize::from(!odd)]));
        }
        all.extend(FORCE.into_iter().zip(&self.force));
        let optional = [
            ("flags", &self.flags),
            ("uniform_force", &self.uniform_force),
            ("guard_state", &self.guard),
            ("wall_velocity", &self.wall_velocity),
            ("eddy_viscosity", &self.eddy_viscosity),
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

/// A read-only storage buffer with this content.
pub(super) fn storage(device: &wgpu::Device, label: &str, contents: &[u8]) -> wgpu::Buffer {
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
    filled(device, label, contents, usage)
}

/// Those of a setup.
pub(super) fn make_buffers(
    device: &wgpu::Device,
    setup: &Setup,
    grid: &Grid,
    geometry: &Geometry,
    bindings: Bindings,
) -> Result<Buffers> {
    let scalars = u64::from(grid.scalar_count());
    let word = super::bytes_per_population(setup.storage);
    let spread = |label, count, bindings, bytes| {
        let planes = planes(count, bindings).into_iter();
        planes
            .map(|own| zeroed(device, label, own.len() as u64 * bytes))
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
    let faces = &geometry.surface_faces;
    let surface = Surface::new(device, setup, grid, faces);
    let list = |label, values: &[u32]| {
        (!values.is_empty()).then(|| storage(device, label, bytemuck::cast_slice(values)))
    };
    Ok(Buffers {
        populations,
        open: OpenBuffers::new(device, setup, grid, geometry),
        names,
        velocity: match (setup.wale, setup.wale_interval) {
            (None, _) => Vec::new(),
            (Some(_), 1) => vec![velocity(), velocity()],
            (Some(_), _) => vec![velocity()],
        },
        eddy_viscosity: setup
            .keeps_eddy_viscosity()
            .then(|| zeroed(device, "eddy viscosity", 4 * scalars)),
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
        near_wall_viscosity: setup
            .wall_model
            .map(|_| zeroed(device, "near-wall viscosity", 4 * scalars)),
        sloping_surface: SurfacePart::new(device, setup, grid, faces, surface.as_ref())?,
        surface,
        walls: WallPart::all(device, setup, &geometry.walls),
        psm_slots: (setup.wall_model.is_some() && setup.solid_operator.is_some()).then(|| {
            let bricks: u32 = grid.bricks().iter().product();
            zeroed(device, "slots of bricks", 4 * u64::from(bricks))
        }),
    })
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
    let inlets = [0, 1, 2].map(|axis| [0, 1].map(|side| inlet_velocities(setup, grid, axis, side)));
    let of = |cell: &MovingCell, axis: usize| {
        let at = grid.padded_cell(cell.cell);
        let Some(side) = moving_side(cell, axis) else {
            return [0.0; 3];
        };
        let (a, b) = in_plane(axis);
        match &setup.faces[axis][side] {
            Face::Wall(velocity) => velocity.map(|v| v as f32),
            Face::Velocity(_) => inlets[axis][side][(at[a] + grid.cells[a] * at[b]) as usize],
            _ => [0.0; 3],
        }
    };
    moving
        .iter()
        .map(|cell| [0, 1, 2].map(|axis| of(cell, axis)))
        .collect()
}

/// Velocities of the cells of a velocity face, lower axis fastest, times the fraction of the cell that static solids leave open:
/// the flow through the face is that through its open area. Empty for other faces.
pub(super) fn inlet_velocities<'a>(
    setup: &'a Setup,
    grid: &Grid,
    axis: usize,
    side: usize,
) -> Cow<'a, [[f32; 3]]> {
    let mut velocities: Cow<'a, [[f32; 3]]> = match &setup.faces[axis][side] {
        Face::Velocity(given) => Cow::Borrowed(given),
        _ => return Cow::default(),
    };
    let [nx, ny, _] = grid.cells;
    let (a, b) = in_plane(axis);
    let layer = [0, grid.cells[axis] - 1][side];
    for solid in &setup.surface {
        let n = solid.cell;
        let at = [n % nx, n / nx % ny, n / (nx * ny)];
        if at[axis] == layer {
            let velocity = &mut velocities.to_mut()[(at[a] + grid.cells[a] * at[b]) as usize];
            *velocity = velocity.map(|u| u * (1.0 - solid.fraction));
        }
    }
    velocities
}

/// The side of the moving face of a cell that is normal to `axis`. Both sides of a domain one cell thick are its own faces; the lower one
/// decides.
pub(super) fn moving_side(cell: &MovingCell, axis: usize) -> Option<usize> {
    let through = cell.through[axis];
    let low = (1..27).any(|q| through & (1 << q) != 0 && super::C[q][axis] < 0);
    (through != 0).then_some(usize::from(!low))
}
