//! The surroundings of each cell: flags, reflecting links, moving and open faces, bricks.

use super::{
    Face, Grid, Setup,
    stages::{FACES, Stages},
    surface,
    surface_faces::SurfaceFaces,
    wall_model::Walls,
};
use crate::gpu::Processor;

/// Directions in the order of `kernels/lattice/lattice.wgsl`, opposites adjacent.
pub const C: [[i32; 3]; 27] = [
    [0, 0, 0],
    [1, 0, 0],
    [-1, 0, 0],
    [0, 1, 0],
    [0, -1, 0],
    [0, 0, 1],
    [0, 0, -1],
    [1, 1, 0],
    [-1, -1, 0],
    [1, 0, 1],
    [-1, 0, -1],
    [0, 1, 1],
    [0, -1, -1],
    [1, -1, 0],
    [-1, 1, 0],
    [1, 0, -1],
    [-1, 0, 1],
    [0, 1, -1],
    [0, -1, 1],
    [1, 1, 1],
    [-1, -1, -1],
    [1, 1, -1],
    [-1, -1, 1],
    [1, -1, 1],
    [-1, 1, -1],
    [-1, 1, 1],
    [1, -1, -1],
];

/// Flag of a cell next to a wall.
pub const NEXT_TO_WALL: u8 = 1 << 6;
/// Flag of a cell that is not fluid.
pub const SOLID: u8 = 1 << 7;

pub(super) fn opposite(q: usize) -> usize {
    if q == 0 { 0 } else { ((q - 1) ^ 1) + 1 }
}

/// The number of a direction.
pub(super) fn direction(c: [i32; 3]) -> usize {
    C.iter().position(|other| *other == c).unwrap_or_default()
}

/// Target of a direction from a fluid cell.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Beyond {
    Fluid,
    /// Static solid or a wall at rest.
    Wall,
    /// A wall or inlet with a velocity, normal to this axis.
    Moving(usize),
    /// Pressure or outflow face, by axis and side.
    Open(usize, usize),
    /// Free-slip faces normal to these axes.
    Slip([bool; 3]),
}

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

pub(super) struct Survey<'a> {
    pub setup: &'a Setup,
    pub grid: &'a Grid,
    periodic: [bool; 3],
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
        let survey = Survey {
            setup,
            grid,
            periodic: setup.periodic_axes(),
        };
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

impl Survey<'_> {
    pub(super) fn is_solid(&self, cell: [u32; 3]) -> bool {
        let solid = &self.setup.solid;
        !solid.is_empty() && solid[self.grid.index(cell)]
    }

    /// Whether static solids fill the cell in part.
    pub(super) fn is_surface(&self, cell: [u32; 3]) -> bool {
        let index = self.grid.index(cell) as u32;
        let surface = &self.setup.surface;
        surface.binary_search_by_key(&index, |s| s.cell).is_ok()
    }

    /// Whether all 26 neighbours are fluid cells of the domain or may be treated so: a shortcut for most
    /// cells. Returns false for cells at faces if solids have to be looked up.
    fn is_inside(&self, cell: [u32; 3]) -> bool {
        let off_the_face = |a: usize| (1..self.grid.cells[a].saturating_sub(1)).contains(&cell[a]);
        let solid = &self.setup.solid;
        if solid.is_empty() {
            return (0..3).all(|a| self.periodic[a] || off_the_face(a));
        }
        if !(0..3).all(off_the_face) {
            return false;
        }
        let [nx, ny, _] = self.grid.cells.map(|n| n as usize);
        let here = self.grid.index(cell);
        let rows = [0, nx, 2 * nx].into_iter().flat_map(|row| {
            [0, nx * ny, 2 * nx * ny].map(|plane| here - nx * ny - nx - 1 + row + plane)
        });
        rows.into_iter()
            .all(|first| !solid[first..first + 3].contains(&true))
    }

    /// The cell next to one in a direction, across periodic faces too; none outside the domain.
    pub(super) fn neighbour_in_domain(&self, cell: [u32; 3], c: [i32; 3]) -> Option<[u32; 3]> {
        self.grid.neighbour_in_domain(cell, c, self.periodic)
    }

    pub(super) fn padded_index(&self, [x, y, z]: [u32; 3]) -> u32 {
        let [nx, ny, _] = self.grid.padded();
        x + nx * (y + ny * z)
    }

    /// The neighbour of a cell on the inside of a face, or the cell itself where that is not fluid.
    fn inner(&self, cell: [u32; 3], axis: usize, side: usize) -> u32 {
        let mut inward = [0; 3];
        inward[axis] = if side == 0 { 1 } else { -1 };
        let inner = self.grid.neighbour(cell, inward);
        let fluid = self.grid.contains(inner) && !self.is_solid(inner);
        self.padded_index(if fluid { inner } else { cell })
    }

    /// Target of direction `q`. If it crosses several faces, the first of velocity, solid, wall, moving wall, pressure or outflow,
    /// free slip applies: so the flow through a velocity face between walls or solids is exact.
    pub(super) fn beyond(&self, cell: [u32; 3], q: usize) -> Beyond {
        let mut to = cell;
        let mut crossed = [None; 3];
        for a in 0..3 {
            let n = i64::from(self.grid.cells[a]);
            let at = i64::from(cell[a]) + i64::from(C[q][a]);
            if (0..n).contains(&at) || self.periodic[a] {
                to[a] = at.rem_euclid(n) as u32;
            } else {
                crossed[a] = Some(usize::from(at >= n));
            }
        }
        // A solid next to the face continues beyond it.
        let nearest = [0, 1, 2].map(|a| if crossed[a].is_some() { cell[a] } else { to[a] });
        if self.is_solid(nearest) {
            let is_inlet = |axis: &usize| {
                let side = crossed[*axis];
                side.is_some_and(|side| matches!(self.setup.faces[*axis][side], Face::Velocity(_)))
            };
            return (0..3).find(is_inlet).map_or(Beyond::Wall, Beyond::Moving);
        }
        let mut found = Beyond::Fluid;
        let mut best = 0;
        let mut slip = [false; 3];
        for (axis, side) in (0..3).filter_map(|a| Some((a, crossed[a]?))) {
            let (rank, beyond) = match &self.setup.faces[axis][side] {
                Face::Velocity(_) => (5, Beyond::Moving(axis)),
                Face::Wall([0.0, 0.0, 0.0]) => (4, Beyond::Wall),
                Face::Wall(_) => (3, Beyond::Moving(axis)),
                Face::Pressure { .. } | Face::Outflow { .. } => (2, Beyond::Open(axis, side)),
                Face::FreeSlip | Face::Periodic => {
                    slip[axis] = true;
                    (1, Beyond::Slip(slip))
                }
            };
            if rank > best || rank == 1 && best == 1 {
                (best, found) = (rank, beyond);
            }
        }
        found
    }

    /// Index of the population that `cell` loads in direction `q` in an even step.
    fn incoming(&self, cell: [u32; 3], q: usize) -> (u32, u32) {
        if q % 2 == 1 {
            (self.grid.scalar_of(cell), q as u32 + 1)
        } else {
            let owner = self.grid.neighbour(cell, C[q - 1]);
            (self.grid.scalar_of(owner), q as u32 - 1)
        }
    }

    /// Adds a link: the population that `sender` sent in direction `sent` returns to `receiver` in direction `received`.
    pub(super) fn link(
        &self,
        sender: [u32; 3],
        sent: usize,
        receiver: [u32; 3],
        received: usize,
    ) -> Link {
        let arrived = self.grid.neighbour(sender, C[sent]);
        let (from, direction_from) = self.incoming(arrived, sent);
        let (to, direction_to) = self.incoming(receiver, received);
        Link {
            from,
            to,
            directions: direction_from | direction_to << 5,
            step: 0,
        }
    }

    /// Specular reflection at the faces normal to `axes`: what enters `cell` against `q` left the
    /// cell next to it towards the same faces; bounce-back where that one is not fluid.
    fn slip(&self, cell: [u32; 3], q: usize, axes: [bool; 3]) -> Link {
        let entering = opposite(q);
        // The entering direction with its normal components reversed towards the face again.
        let sent = [0, 1, 2].map(|a| if axes[a] { C[q][a] } else { C[entering][a] });
        let tangential = [0, 1, 2].map(|a| if axes[a] { 0 } else { C[q][a] });
        let along = direction(tangential);
        let sent = direction(sent);
        if along == 0 {
            return self.link(cell, sent, cell, entering);
        }
        if self.beyond(cell, along) != Beyond::Fluid {
            return self.link(cell, q, cell, entering);
        }
        let sender = [0, 1, 2].map(|a| {
            let n = i64::from(self.grid.cells[a]);
            (i64::from(cell[a]) + i64::from(tangential[a])).rem_euclid(n) as u32
        });
        self.link(sender, sent, cell, entering)
    }
}
