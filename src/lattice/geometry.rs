//! The surroundings of each cell: flags, reflecting links, moving and open faces, bricks.

use super::{
    Face, Grid, Setup,
    directions::opposite,
    stages::{FACES, Stages},
    surface,
    surface_faces::SurfaceFaces,
    survey::{Beyond, Survey},
    wall_model::Walls,
};
use crate::gpu::Processor;

/// Flag of a cell next to a wall.
pub const NEXT_TO_WALL: u8 = 1 << 6;
/// Flag of a cell that is not fluid.
pub const SOLID: u8 = 1 << 7;

/// A cell whose face moves, as `moving_wall.wgsl` reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub struct MovingCell {
    /// Index in the padded grid.
    pub cell: u32,
    /// Directions through the moving faces normal to x, y, z, one bit each.
    pub through: [u32; 3],
}

/// A cell at an open face of the domain, as `face_cells.wgsl` reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub struct FaceCell {
    /// Index in the padded grid.
    pub cell: u32,
    /// The next cell inside.
    pub inner: u32,
    /// Directions that enter through the face, one bit each.
    pub entering: u32,
    /// The face: 0 to 5 for x−, x+, y−, …
    pub face: u32,
    /// Its turn among the dispatches of a stage: one after the other where several faces of a cell without an inner neighbour
    /// read the cell itself.
    pub turn: u32,
}

/// A reflected population, as `link.wgsl` reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Link {
    /// Scalar read.
    pub from: u32,
    /// Scalar written.
    pub to: u32,
    /// Directions of both words in an even step, 5 bits each.
    pub directions: u32,
    /// Scalars from this link to the next of its row, read and written.
    pub step: u32,
}

/// Links of a row: with the same directions, at equal distances.
pub const LINKS_OF_ROW: usize = 8;

/// The surroundings of all cells.
#[derive(Debug, Default)]
pub struct Geometry {
    /// A byte for each lane of an element, as `cell_flags_stored.wgsl` explains them; empty where
    /// all cells are fluid without neighbours of another kind.
    pub flags: Vec<u32>,
    /// Populations that walls at rest and free-slip faces return: the first of each row.
    pub link_rows: Vec<Link>,
    /// Those in no row.
    pub links: Vec<Link>,
    /// Cells at walls whose friction a law of the wall gives, and their links.
    pub walls: Walls,
    /// Faces of exact surfaces whose friction a law of the wall gives.
    pub surface_faces: SurfaceFaces,
    /// Cells at moving walls and velocity faces; in the order of their stages.
    pub moving: Vec<MovingCell>,
    /// Cells of pressure faces in the order of their stages, once for each face.
    pub pressure: Vec<FaceCell>,
    /// Cells of outflow faces likewise.
    pub outflow: Vec<FaceCell>,
    /// The order in which the cells of these three are completed.
    pub stages: Stages,
    /// Bricks of plain fluid that run the kernel without flags.
    pub plain: Vec<u32>,
    /// Bricks that run the kernel with flags.
    pub mixed: Vec<u32>,
    /// Bricks with cells that static solids fill in part, or with neighbours of such cells.
    pub surface: Vec<u32>,
    /// Bricks without a fluid cell.
    pub solid_bricks: u32,
    /// Fluid cells.
    pub fluid_cells: u64,
}

/// Sets the turns of the faces of each cell, which follow one another in the list.
fn set_turns(cells: &mut [FaceCell]) {
    for faces in cells.chunk_by_mut(|a, b| a.cell == b.cell) {
        if faces.len() == 1 {
            continue;
        }
        let alone = |face: &&mut FaceCell| face.inner == face.cell;
        for (turn, face) in (1..).zip(faces.iter_mut().filter(alone)) {
            face.turn = turn;
        }
    }
}

impl Geometry {
    /// Determines the surroundings of all cells of a setup.
    pub fn new(setup: &Setup, grid: &Grid) -> Self {
        if setup.is_all_fluid() {
            return Self {
                fluid_cells: grid.cell_count() as u64,
                ..Self::default()
            };
        }
        let survey = Survey::new(setup, grid);
        let mut geometry = Self {
            flags: vec![0x8080_8080; grid.element_count() as usize],
            ..Self::default()
        };
        for cell in grid.domain() {
            if survey.is_solid(cell) {
                continue;
            }
            geometry.fluid_cells += 1;
            let bits = if survey.is_inside(cell) {
                0
            } else {
                geometry.survey_cell(&survey, cell)
            };
            let (element, lane) = grid.element_of(cell);
            let word = &mut geometry.flags[element as usize];
            *word = *word & !(0xff << (8 * lane)) | u32::from(bits) << (8 * lane);
        }
        geometry.join_links(grid);
        geometry.walls.own_layers(grid);
        geometry.surface_faces = SurfaceFaces::new(&survey, &geometry.walls);
        geometry.walls.area = geometry.surface_faces.area(geometry.walls.area);
        for cells in [&mut geometry.pressure, &mut geometry.outflow] {
            set_turns(cells);
        }
        geometry.stages = Stages::new([&geometry.pressure, &geometry.outflow]);
        geometry.stages.sort(&mut geometry.moving, grid);
        geometry.stages.sort(&mut geometry.pressure, grid);
        geometry.stages.sort(&mut geometry.outflow, grid);
        geometry.sort_bricks(grid);
        geometry.surface = surface::bricks(setup, grid);
        for list in [&mut geometry.mixed, &mut geometry.plain] {
            list.retain(|brick| geometry.surface.binary_search(brick).is_err());
        }
        if setup.processor == Some(Processor::Cpu) {
            geometry.merge_bricks();
        }
        geometry
    }

    /// Whether a brick has a fluid cell.
    pub fn runs(&self, brick: u32) -> bool {
        let lists = [&self.mixed, &self.plain, &self.surface];
        lists.iter().any(|list| list.binary_search(&brick).is_ok())
    }

    /// Adds the links of a cell and returns its flags.
    fn survey_cell(&mut self, survey: &Survey<'_>, cell: [u32; 3]) -> u8 {
        let mut bits = 0;
        let surroundings: [Beyond; 27] = std::array::from_fn(|q| match q {
            0 => Beyond::Fluid,
            _ => survey.beyond(cell, q),
        });
        let modelled = survey.modelled(cell, &surroundings);
        let mut moving = MovingCell {
            cell: survey.padded_index(cell),
            through: [0; 3],
        };
        for q in 1..27 {
            let beyond = surroundings[q];
            if beyond != Beyond::Fluid && q < 7 {
                // Directions 1..6 are +x, -x, +y, ...; flags go -x, +x, -y, ...
                bits |= 1 << ((q - 1) ^ 1);
            }
            if matches!(beyond, Beyond::Wall | Beyond::Moving(_)) {
                bits |= NEXT_TO_WALL;
            }
            let enters = opposite(q);
            match beyond {
                Beyond::Fluid => {}
                // The wall model has their links.
                Beyond::Wall if modelled.is_some_and(|faces| faces.has_link(q)) => {}
                Beyond::Wall => self.links.push(survey.link(cell, q, cell, enters)),
                Beyond::Moving(axis) => moving.through[axis] |= 1 << q,
                Beyond::Slip(axes) => {
                    let link = survey.slip(cell, q, axes);
                    self.links.push(link);
                }
                Beyond::Open(axis, side) => {
                    let cells = match survey.setup.faces[axis][side] {
                        Face::Outflow { .. } => &mut self.outflow,
                        _ => &mut self.pressure,
                    };
                    let face = (2 * axis + side) as u32;
                    let here = survey.padded_index(cell);
                    let mut last = cells.iter_mut().rev().take(FACES);
                    let found = last.find(|last| (last.cell, last.face) == (here, face));
                    match found {
                        Some(found) => found.entering |= 1 << enters,
                        None => cells.push(FaceCell {
                            cell: here,
                            inner: survey.inner(cell, axis, side),
                            entering: 1 << enters,
                            face,
                            turn: 0,
                        }),
                    }
                }
            }
        }
        if moving.through != [0; 3] {
            self.moving.push(moving);
        }
        self.walls.area += surroundings[1..7]
            .iter()
            .filter(|b| **b == Beyond::Wall)
            .count() as u64;
        if let Some(faces) = modelled {
            self.walls.push(survey, cell, faces);
        }
        bits
    }

    /// Number of populations that walls at rest and free-slip faces return.
    pub fn link_count(&self) -> usize {
        LINKS_OF_ROW * self.link_rows.len() + self.links.len()
    }

    /// Sorts the links by direction and memory address, and joins them to rows.
    fn join_links(&mut self, grid: &Grid) {
        let mut links = std::mem::take(&mut self.links);
        links.sort_unstable_by_key(|link| (link.directions, link.to % grid.lanes, link.to));
        let step = |a: &Link, b: &Link| {
            let [from, to] = [b.from.wrapping_sub(a.from), b.to.wrapping_sub(a.to)];
            (a.directions == b.directions && from == to).then_some(to)
        };
        let mut rest = &links[..];
        while let Some(&first) = rest.first() {
            let row = rest.get(..LINKS_OF_ROW).unwrap_or_default();
            let mut steps = row.windows(2).map(|two| step(&two[0], &two[1]));
            let next = steps.next().flatten();
            match next.filter(|_| steps.all(|other| other == next)) {
                Some(step) => {
                    self.link_rows.push(Link { step, ..first });
                    rest = &rest[LINKS_OF_ROW..];
                }
                None => {
                    self.links.push(first);
                    rest = &rest[1..];
                }
            }
        }
    }

    fn sort_bricks(&mut self, grid: &Grid) {
        let [bx, by, bz] = grid.bricks();
        let [nx, ny, nz] = grid.elements;
        let all_solid = (0..grid.lanes).fold(0, |word, l| word | u32::from(SOLID) << (8 * l));
        let used = if grid.lanes == 4 {
            u32::MAX
        } else {
            (1 << (8 * grid.lanes)) - 1
        };
        for (brick, [x, y, z]) in (0..)
            .zip((0..bz).flat_map(|z| (0..by).flat_map(move |y| (0..bx).map(move |x| [x, y, z]))))
        {
            let range = |at: u32, size: u32, n: u32| at * size..((at + 1) * size).min(n);
            let (mut flagged, mut solid) = (false, true);
            for k in range(z, grid.brick[2], nz) {
                for j in range(y, grid.brick[1], ny) {
                    for i in range(x, grid.brick[0], nx) {
                        let word = self.flags[(i + nx * (j + ny * k)) as usize] & used;
                        flagged |= word != 0;
                        solid &= word & all_solid == all_solid;
                    }
                }
            }
            let first = [x * grid.brick[0], y * grid.brick[1], z * grid.brick[2]];
            match (flagged, solid) {
                // It consists of padding, which no kernel has to skip.
                (_, true) if !grid.contains(first) => {}
                (_, true) => self.solid_bricks += 1,
                (true, _) => self.mixed.push(brick),
                (false, _) => self.plain.push(brick),
            }
        }
    }

    /// Runs all bricks by the kernel with flags if fewer bricks are plain fluid: on a CPU the locality of consecutive
    /// bricks saves more time than flags cost.
    fn merge_bricks(&mut self) {
        if self.plain.len() < self.mixed.len() {
            self.mixed.append(&mut self.plain);
            self.mixed.sort_unstable();
        }
    }
}
