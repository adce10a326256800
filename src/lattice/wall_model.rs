//! Walls with the wall model: their cells, and the stress on them.

use super::{
    C, Grid, Lattice, Link, Setup,
    boundary::cell_pass,
    buffers::storage,
    cell_kernels::CellDispatch,
    directions::{direction, opposite},
    fluid::{Dispatch, in_plane},
    survey::{Beyond, Survey},
};
use crate::{
    Result,
    gpu::{
        buffers::zeroed,
        kernel::{largest_binding, submit_pass},
        readback::Readback,
    },
};
use bytemuck::{Pod, Zeroable};
use std::collections::HashSet;

/// Directions into a plane wall.
const LINKS: usize = 9;
/// Directions with a component along the edge between two walls that lead into one of these.
const EDGE_LINKS: usize = 10;
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
    /// Cells at plane walls at rest, by the face and the order of memory; then those at edges between two such walls, twice each.
    pub cells: Vec<WallCell>,
    /// Faces of fluid cells that are walls at rest, those of the model and all others.
    pub area: u64,
    /// Links of each cell into the plane wall, by their tangential direction.
    links: Vec<[Link; LINKS]>,
    /// Faces of the cells at edges, and their links along the edge.
    edges: Vec<([WallCell; 2], [Link; EDGE_LINKS])>,
}

/// The faces of a cell where the model acts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Modelled {
    /// A plane wall.
    Plane(usize),
    /// Two walls that meet at an edge, by ascending axis.
    Edge([usize; 2]),
}

impl Modelled {
    /// Whether the model has the link in a direction that leads into a wall.
    pub fn has_link(self, q: usize) -> bool {
        match self {
            Self::Plane(_) => true,
            Self::Edge([a, b]) => C[q][along_edge(a, b)] != 0,
        }
    }
}

/// The axis of the edge between two faces.
fn along_edge(a: usize, b: usize) -> usize {
    3 - a / 2 - b / 2
}

/// The direction out of a cell through a face.
fn through(face: usize) -> [i32; 3] {
    let mut c = [0; 3];
    c[face / 2] = [-1, 1][face % 2];
    c
}

impl Walls {
    /// Adds the faces of a cell.
    pub(super) fn push(&mut self, survey: &Survey<'_>, cell: [u32; 3], faces: Modelled) {
        let link = |c| {
            let into = direction(c);
            survey.link(cell, into, cell, opposite(into))
        };
        match faces {
            Modelled::Plane(face) => {
                self.cells.push(survey.wall_cell(cell, face));
                let (a, b) = in_plane(face / 2);
                self.links.push(std::array::from_fn(|j| {
                    let mut c = through(face);
                    (c[a], c[b]) = (j as i32 % 3 - 1, j as i32 / 3 - 1);
                    link(c)
                }));
            }
            Modelled::Edge([a, b]) => {
                let (out_a, out_b) = (through(a), through(b));
                // Multiples of the directions out of the cell through both faces.
                let parts = [(1, 0), (0, 1), (1, 1), (1, -1), (-1, 1)];
                let links = std::array::from_fn(|j| {
                    let (part_a, part_b) = parts[j / 2];
                    let mut c = [0, 1, 2].map(|axis| part_a * out_a[axis] + part_b * out_b[axis]);
                    c[along_edge(a, b)] = [-1, 1][j % 2];
                    link(c)
                });
                let cells = [a, b].map(|face| survey.wall_cell(cell, face));
                self.edges.push((cells, links));
            }
        }
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
        for ([first, _], _) in &mut self.edges {
            first.layers = 1;
            taken.insert(grid.padded_cell(first.cell));
        }
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
        let of_edges = self.edges.iter().flat_map(|(cells, _)| cells);
        self.cells.extend(of_edges.copied());
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
    /// The faces of a cell where the model acts: the directions through one or two faces lead to walls at rest, and no other one does,
    /// or through an open or moving face, and five cells of fluid lie before each.
    pub(super) fn modelled(&self, cell: [u32; 3], beyond: &[Beyond; 27]) -> Option<Modelled> {
        self.setup.wall_model?;
        let is_wall = |face: &usize| beyond[direction(through(*face))] == Beyond::Wall;
        let walls: Vec<usize> = (0..6).filter(is_wall).collect();
        let found = match walls[..] {
            [face] => Modelled::Plane(face),
            [a, b] if a / 2 != b / 2 => Modelled::Edge([a, b]),
            _ => return None,
        };
        let leads_out = |q: usize| {
            let is_through = |face: &usize| C[q][face / 2] == [-1, 1][face % 2];
            walls.iter().any(is_through)
        };
        let are_alone = (1..27).all(|q| match beyond[q] {
            Beyond::Wall => leads_out(q),
            Beyond::Fluid | Beyond::Slip(_) => !leads_out(q),
            Beyond::Moving(_) | Beyond::Open(..) => false,
        });
        let have_fluid = || walls.iter().all(|&face| self.has_depth(cell, face));
        (are_alone && have_fluid()).then_some(found)
    }

    /// Whether five cells of fluid lie before a face.
    fn has_depth(&self, cell: [u32; 3], face: usize) -> bool {
        let inward = through(face).map(|c| -c);
        let q = direction(inward);
        let mut at = cell;
        for _ in 1..DEPTH {
            if self.is_surface(at) || self.beyond(at, q) != Beyond::Fluid {
                return false;
            }
            at = self.grid.neighbour(at, inward);
        }
        !self.is_surface(at)
    }

    fn wall_cell(&self, cell: [u32; 3], face: usize) -> WallCell {
        let (axis, side) = (face / 2, face % 2);
        let setup = self.setup;
        let at_end = cell[axis] == [0, self.grid.cells[axis] - 1][side];
        let roughness = if at_end && !setup.periodic_axes()[axis] {
            setup.wall_roughness[axis][side] as f32
        } else if setup.solid_roughness.is_empty() {
            0.0
        } else {
            setup.solid_roughness[self.grid.index(self.grid.neighbour(cell, through(face)))]
        };
        WallCell {
            cell: self.padded_index(cell),
            face: face as u32,
            layers: 0,
            roughness,
        }
    }
}

/// The walls of one dispatch.
#[derive(Debug)]
pub(super) struct WallPart {
    /// Kernels that apply the law, and that set only the eddy viscosity.
    entries: [&'static str; 2],
    /// Invocations of these.
    invocations: u32,
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
        let largest = largest_binding(&device.limits()) as usize;
        let most = |bytes: usize| (largest / bytes).max(1);
        let planes = most(size_of::<[Link; LINKS]>());
        let planes = walls.cells.chunks(planes).zip(walls.links.chunks(planes));
        let planes = planes.map(|(cells, links)| {
            let entries = ["wall_model", "near_wall"];
            Self::new(device, setup, entries, &cells[..links.len()], links)
        });
        let edges = most(size_of::<[Link; EDGE_LINKS]>());
        let edges = walls.edges.chunks(edges).map(|own| {
            let cells: Vec<_> = own.iter().flat_map(|(cells, _)| *cells).collect();
            let links: Vec<_> = own.iter().map(|(_, links)| *links).collect();
            Self::new(device, setup, ["wall_edges", "near_edges"], &cells, &links)
        });
        planes.chain(edges).collect()
    }

    fn new<const N: usize>(
        device: &wgpu::Device,
        setup: &Setup,
        entries: [&'static str; 2],
        cells: &[WallCell],
        own: &[[Link; N]],
    ) -> Self {
        let each = (0..N).flat_map(|j| own.iter().map(move |links| links[j]));
        let links: Vec<Link> = each.collect();
        let result = |label, bytes| zeroed(device, label, bytes * cells.len() as u64);
        Self {
            entries,
            invocations: own.len() as u32,
            cells: storage(device, "wall cells", bytemuck::cast_slice(cells)),
            links: storage(device, "wall links", bytemuck::cast_slice(&links)),
            stress: result("wall stress", size_of::<WallStress>() as u64),
            blocks: setup.solid_operator.map(|_| result("walls with blocks", 4)),
            count: cells.len() as u32,
        }
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

/// Which of `count` cells `blocks` marks as near a block; none without blocks.
pub(super) async fn marks(
    readback: &mut Readback,
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    blocks: Option<&wgpu::Buffer>,
    count: usize,
) -> Result<Vec<bool>> {
    let Some(blocks) = blocks else {
        return Ok(vec![false; count]);
    };
    let marks: Vec<u32> = readback.read(device, queue, blocks, count).await?;
    Ok(marks.into_iter().map(|mark| mark != 0).collect())
}

impl Lattice {
    /// The passes over the walls of the model in a step of the given parity.
    pub(super) fn wall_passes(&self, device: &wgpu::Device, odd: u32) -> Result<Vec<Dispatch>> {
        self.passes_of_walls(device, 0, odd)
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
            false => passes.extend(self.passes_of_walls(device, 1, odd)?),
        }
        submit_pass(device, queue, |pass| {
            passes.iter().for_each(|dispatch| dispatch.record(pass));
        });
        Ok(())
    }

    fn passes_of_walls(
        &self,
        device: &wgpu::Device,
        entry: usize,
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
                    entry: part.entries[entry],
                    pass: cell_pass(odd, half, &(0..part.invocations as usize)),
                    buffers: &buffers,
                    constants: &[],
                    invocations: part.invocations,
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

    /// Whether each cell of [`Walls::cells`] had a block nearby in the last step, so that the wall was no-slip.
    ///
    /// # Errors
    /// If the device fails.
    pub async fn walls_near_blocks(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
    ) -> Result<Vec<bool>> {
        let mut all = Vec::new();
        let mut readback = Readback::default();
        for part in &self.buffers.walls {
            let count = part.count as usize;
            let own = marks(&mut readback, device, queue, part.blocks.as_ref(), count).await?;
            all.extend(own);
        }
        Ok(all)
    }
}
