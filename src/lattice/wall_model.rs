//! Walls with the wall model: their cells, and the stress on them.

use super::{
    Grid, Lattice, Link, Setup,
    boundary::cell_pass,
    buffers::storage,
    cell_kernels::CellDispatch,
    fluid::{Dispatch, in_plane},
    geometry::{Beyond, C, Survey, opposite},
};
use crate::{
    Result,
    gpu::{buffers::zeroed, kernel::largest_binding, readback::Readback},
};
use bytemuck::{Pod, Zeroable};
use std::collections::HashSet;

/// Directions into a plane wall.
const LINKS: usize = 9;
/// Number of fluid cells in front of a wall that the model needs.
const DEPTH: u32 = 5;
/// Number of these whose eddy viscosity follows from the wall.
const LAYERS: u32 = 4;

/// A cell at such a wall, with the layout of `kernels/lattice/wall_model.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct WallCell {
    /// Index in the padded grid.
    pub cell: u32,
    /// The face of the cell that is the wall: x−, x+, y−, y+, z−, z+.
    pub face: u32,
    /// Number of cells in front of the wall whose eddy viscosity follows from it, up to 4: fewer if another wall is nearer.
    pub layers: u32,
    /// Equivalent sand roughness, cells; 0 for a smooth wall.
    pub roughness: f32,
}

/// Result of the model for a wall cell in a step, with the layout of `kernels/lattice/wall_model.wgsl`; lattice units.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct WallStress {
    /// Tangential stress on the wall, along the lower and the upper axis of its face.
    pub stress: [f32; 2],
    /// Friction velocity by the law of the wall.
    pub friction: f32,
    /// Fraction of the stress that comes from the law: 0 for a no-slip wall, 1 for the law alone.
    pub share: f32,
}

/// The walls of the model.
#[derive(Debug, Default)]
pub struct Walls {
    /// Cells at plane walls at rest, by the face and the order of memory.
    pub cells: Vec<WallCell>,
    /// Faces of fluid cells that are walls at rest, those of the model and all others.
    pub area: u64,
    /// Links of each cell into the wall, by their tangential direction.
    links: Vec<[Link; LINKS]>,
}

impl Walls {
    /// Adds a cell whose face is a plane wall.
    pub(super) fn push(&mut self, survey: &Survey<'_>, cell: [u32; 3], face: usize) {
        let (axis, side) = (face / 2, face % 2);
        let setup = survey.setup;
        let at_end = cell[axis] == [0, survey.grid.cells[axis] - 1][side];
        let roughness = if at_end && !setup.periodic_axes()[axis] {
            setup.wall_roughness[axis][side] as f32
        } else if setup.solid_roughness.is_empty() {
            0.0
        } else {
            let mut out = [0; 3];
            out[axis] = [-1, 1][side];
            setup.solid_roughness[survey.grid.index(survey.grid.neighbour(cell, out))]
        };
        self.cells.push(WallCell {
            cell: survey.padded_index(cell),
            face: face as u32,
            layers: 0,
            roughness,
        });
        let (a, b) = in_plane(axis);
        self.links.push(std::array::from_fn(|j| {
            let mut c = [0; 3];
            c[axis] = [-1, 1][side];
            (c[a], c[b]) = (j as i32 % 3 - 1, j as i32 / 3 - 1);
            let into = C.iter().position(|other| *other == c).unwrap_or_default();
            survey.link(cell, into, cell, opposite(into))
        }));
    }

    /// Sorts the cells, and assigns each fluid cell near a wall to the nearest wall.
    pub(super) fn own_layers(&mut self, grid: &Grid) {
        let place = |n: &usize| {
            let cell = &self.cells[*n];
            (cell.face, grid.scalar_of(grid.padded_cell(cell.cell)))
        };
        let mut order: Vec<usize> = (0..self.cells.len()).collect();
        order.sort_unstable_by_key(place);
        self.cells = order.iter().map(|&n| self.cells[n]).collect();
        self.links = order.iter().map(|&n| self.links[n]).collect();
        let mut taken = HashSet::new();
        for layer in 0..LAYERS {
            for wall in &mut self.cells {
                let mut inward = [0; 3];
                inward[wall.face as usize / 2] =
                    [layer as i32, -(layer as i32)][wall.face as usize % 2];
                let cell = grid.neighbour(grid.padded_cell(wall.cell), inward);
                if wall.layers == layer && taken.insert(cell) {
                    wall.layers += 1;
                }
            }
        }
    }
}

impl Walls {
    /// The cells whose eddy viscosity follows from these walls.
    pub(super) fn layer_cells(&self, grid: &Grid) -> impl Iterator<Item = [u32; 3]> {
        self.cells.iter().flat_map(move |wall| {
            let mut inward = [0; 3];
            inward[wall.face as usize / 2] = [1, -1][wall.face as usize % 2];
            let at = move |layer: u32| inward.map(|c| c * layer as i32);
            (0..wall.layers)
                .map(move |layer| grid.neighbour(grid.padded_cell(wall.cell), at(layer)))
        })
    }
}

/// Share of the law at a friction velocity, as `law_of_the_wall.wgsl` has it.
pub(super) fn model_share(friction: f32, nu: f64) -> f32 {
    let s = ((0.5 * friction / nu as f32 - 3.0) / 3.0).clamp(0.0, 1.0);
    s * s * (3.0 - 2.0 * s)
}

impl Survey<'_> {
    /// The face of a cell where the model acts: the nine directions through it lead to walls at rest, and no other one does,
    /// or through an open or moving face, and five cells of fluid lie before it.
    pub(super) fn plain_wall(&self, cell: [u32; 3], beyond: &[Beyond; 27]) -> Option<usize> {
        self.setup.wall_model?;
        let through = |face: usize| {
            let (axis, out) = (face / 2, [-1, 1][face % 2]);
            (1..27).all(|q| match beyond[q] {
                Beyond::Wall => C[q][axis] == out,
                Beyond::Fluid | Beyond::Slip(_) => C[q][axis] != out,
                Beyond::Moving(_) | Beyond::Open(..) => false,
            })
        };
        let face = (0..6).find(|&face| through(face))?;
        let mut inward = [0; 3];
        inward[face / 2] = [1, -1][face % 2];
        let q = C.iter().position(|c| *c == inward)?;
        let mut at = cell;
        for _ in 1..DEPTH {
            if self.is_surface(at) || self.beyond(at, q) != Beyond::Fluid {
                return None;
            }
            at = self.grid.neighbour(at, inward);
        }
        (!self.is_surface(at)).then_some(face)
    }
}

/// The walls of one dispatch.
#[derive(Debug)]
pub(super) struct WallPart {
    cells: wgpu::Buffer,
    links: wgpu::Buffer,
    /// Results of the last step.
    stress: wgpu::Buffer,
    /// Which of them had a block nearby in the last step; only with blocks.
    blocks: Option<wgpu::Buffer>,
    count: u32,
}

impl WallPart {
    /// The walls of a geometry.
    pub fn all(device: &wgpu::Device, setup: &Setup, walls: &Walls) -> Vec<Self> {
        let most = largest_binding(&device.limits()) as usize / size_of::<[Link; LINKS]>();
        let parts = walls
            .cells
            .chunks(most.max(1))
            .zip(walls.links.chunks(most.max(1)));
        let part = |(cells, own): (&[WallCell], &[[Link; LINKS]])| {
            let links: Vec<Link> = (0..LINKS)
                .flat_map(|j| own.iter().map(move |links| links[j]))
                .collect();
            let result = |label, bytes| zeroed(device, label, bytes * cells.len() as u64);
            Self {
                cells: storage(device, "wall cells", bytemuck::cast_slice(cells)),
                links: storage(device, "wall links", bytemuck::cast_slice(&links)),
                stress: result("wall stress", size_of::<WallStress>() as u64),
                blocks: setup.solid_operator.map(|_| result("walls with blocks", 4)),
                count: cells.len() as u32,
            }
        };
        parts.map(part).collect()
    }

    /// Bytes of its buffers.
    pub fn bytes(&self) -> u64 {
        let kept = [&self.cells, &self.links, &self.stress];
        kept.into_iter()
            .chain(&self.blocks)
            .map(wgpu::Buffer::size)
            .sum()
    }
}

impl Lattice {
    /// The passes over the walls of the model in a step of the given parity.
    pub(super) fn wall_passes(&self, device: &wgpu::Device, odd: u32) -> Result<Vec<Dispatch>> {
        self.passes_of_walls(device, "wall_model", odd)
    }

    /// Evaluates the law for a complete state, and sets the eddy viscosity next to walls unless it is `known`; in a step the
    /// boundary passes do so.
    pub(super) fn set_near_wall(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        known: bool,
    ) -> Result<()> {
        let odd = self.parity() as u32;
        let mut passes = self.surface_laws(device, odd)?;
        match known {
            true => passes.truncate(1),
            false => passes.extend(self.passes_of_walls(device, "near_wall", odd)?),
        }
        let mut encoder = device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            for dispatch in &passes {
                dispatch.record(&mut pass);
            }
        }
        queue.submit([encoder.finish()]);
        Ok(())
    }

    fn passes_of_walls(
        &self,
        device: &wgpu::Device,
        entry: &'static str,
        odd: u32,
    ) -> Result<Vec<Dispatch>> {
        let program = self.cell_program("wall_model");
        let mut passes = Vec::new();
        for part in &self.buffers.walls {
            let mut buffers = vec![
                ("wall_cells", &part.cells),
                ("wall_links", &part.links),
                ("wall_stress", &part.stress),
            ];
            buffers.extend(part.blocks.as_ref().map(|blocks| ("wall_blocks", blocks)));
            for half in self.halves() {
                let dispatch = CellDispatch {
                    program: &program,
                    entry,
                    pass: cell_pass(odd, half, &(0..part.count as usize)),
                    buffers: &buffers,
                    constants: &[],
                    invocations: part.count,
                };
                passes.push(self.cell_dispatch(device, &dispatch)?);
            }
        }
        Ok(passes)
    }

    /// The dispatches that find the walls with blocks nearby for the next step.
    pub(super) fn mark_passes(&self, device: &wgpu::Device) -> Result<Vec<Dispatch>> {
        let program = self.cell_program("mark_blocks");
        let mark = |part: &WallPart| {
            let mut buffers = vec![("wall_cells", &part.cells)];
            buffers.extend(part.blocks.as_ref().map(|blocks| ("wall_blocks", blocks)));
            buffers.extend(self.psm_planes());
            let dispatch = CellDispatch {
                program: &program,
                entry: "mark_blocks",
                pass: cell_pass(0, 0, &(0..part.count as usize)),
                buffers: &buffers,
                constants: &[],
                invocations: part.count,
            };
            self.cell_dispatch(device, &dispatch)
        };
        match self.setup.solid_operator {
            Some(_) => self.buffers.walls.iter().map(mark).collect(),
            None => Ok(Vec::new()),
        }
    }

    /// The buffer with the number of each brick among those that blocks reach, from 1.
    pub(super) fn write_psm_slots(&self, queue: &wgpu::Queue, bricks: &[u32]) {
        if let Some(buffer) = &self.buffers.psm_slots {
            let mut slots = vec![0u32; buffer.size() as usize / 4];
            for (slot, brick) in (1..).zip(bricks) {
                slots[*brick as usize] = slot;
            }
            queue.write_buffer(buffer, 0, bytemuck::cast_slice(&slots));
        }
    }

    /// Reads the results for each cell of [`Walls::cells`] in the last step.
    ///
    /// # Errors
    /// If the device fails.
    pub async fn wall_stresses(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
    ) -> Result<Vec<WallStress>> {
        let mut all = Vec::new();
        let mut readback = Readback::default();
        for part in &self.buffers.walls {
            let own: Vec<WallStress> = readback
                .read(device, queue, &part.stress, part.count as usize)
                .await?;
            all.extend(own);
        }
        Ok(all)
    }
}
