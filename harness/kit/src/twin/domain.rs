//! Grid, faces, solids, and the links along which populations leave a cell.

use super::lattice::{C, OPPOSITE, Q, direction};

/// Velocity over a face.
#[derive(Clone, Debug)]
pub enum Profile {
    /// The same everywhere.
    Uniform([f64; 3]),
    /// One value per cell of the face, the lower of the two other axes running fastest.
    Table(Vec<[f64; 3]>),
}

/// One side of the domain.
#[derive(Clone, Debug)]
pub enum Face {
    /// Connected to the opposite face, which must be periodic too.
    Periodic,
    /// No-slip wall, half a cell beyond the last centres; at rest when the velocity is zero.
    Wall([f64; 3]),
    /// Velocity imposed like a moving wall that lets mass through.
    Velocity(Profile),
    /// Mirror.
    FreeSlip,
}

/// Source of the population that arrives at a cell in place of one that left it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Link {
    /// The neighbour is fluid: its population of the opposite direction.
    Fluid(usize),
    /// Half-way bounce-back off a wall at rest.
    Bounce,
    /// Half-way bounce-back off a wall of this velocity.
    Moving([f64; 3]),
    /// Population `direction` of `cell`, reflected by free-slip faces.
    Mirror {
        /// Cell of the population.
        cell: usize,
        /// Direction of the population there.
        direction: usize,
    },
}

/// The grid and its boundaries.
#[derive(Clone, Debug)]
pub struct Domain {
    /// Number of cells along each axis.
    pub cells: [usize; 3],
    /// x_min, x_max, y_min, y_max, z_min, z_max.
    pub faces: [Face; 6],
    /// Static no-slip solids.
    pub solid: Vec<bool>,
}

impl Domain {
    /// A box without solids.
    pub fn new(cells: [usize; 3], faces: [Face; 6]) -> Self {
        let solid = vec![false; cells.iter().product()];
        Self {
            cells,
            faces,
            solid,
        }
    }

    /// A box that is periodic in every direction.
    pub fn periodic(cells: [usize; 3]) -> Self {
        Self::new(cells, [const { Face::Periodic }; 6])
    }

    /// Number of cells.
    pub fn cell_count(&self) -> usize {
        self.solid.len()
    }

    /// Index of a cell.
    pub fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        x + self.cells[0] * (y + self.cells[1] * z)
    }

    /// Position of a cell on the grid.
    pub fn position(&self, cell: usize) -> [usize; 3] {
        let [nx, ny, _] = self.cells;
        [cell % nx, cell / nx % ny, cell / (nx * ny)]
    }

    /// Outward normals, along the axes, of the walls at rest and solids next to a cell.
    pub fn walls_at(&self, cell: usize) -> impl Iterator<Item = [i32; 3]> {
        let bounces = move |c: &[i32; 3]| self.link(cell, direction(*c)) == Link::Bounce;
        let normal = |n: usize| {
            let mut c = [0; 3];
            c[n / 2] = [-1, 1][n % 2];
            c
        };
        (0..6).map(normal).filter(bounces)
    }

    /// The next fluid cell along `axis` (`step` = ±1), across a periodic face too.
    pub fn fluid_neighbour(&self, cell: usize, axis: usize, step: i32) -> Option<usize> {
        let mut c = [0; 3];
        c[axis] = step;
        match self.link(cell, direction(c)) {
            Link::Fluid(neighbour) => Some(neighbour),
            _ => None,
        }
    }

    /// The link that leaves a fluid cell in direction `i`.
    ///
    /// Where several boundaries meet, this order decides: velocity face, solid, wall at rest, moving wall, free slip;
    /// between two of a kind the one on the lower axis.
    /// A link that leaves the domain along a solid, so that it meets the edge between the two, counts as meeting both.
    pub fn link(&self, cell: usize, i: usize) -> Link {
        let position = self.position(cell);
        let (beside, crossed) = self.walk(position, C[i]);
        let neighbour = self.index(beside);
        let decisive = (0..3)
            .filter_map(|axis| crossed[axis])
            .min_by_key(|&face| rank(&self.faces[face]));
        let inlet = decisive.filter(|&face| matches!(self.faces[face], Face::Velocity(_)));
        if self.solid[neighbour] && inlet.is_none() {
            return Link::Bounce;
        }
        let Some(face) = decisive else {
            return Link::Fluid(neighbour);
        };
        match &self.faces[face] {
            Face::Wall([0.0, 0.0, 0.0]) => Link::Bounce,
            Face::Wall(velocity) => Link::Moving(*velocity),
            Face::Velocity(profile) => {
                Link::Moving(self.profile_velocity(profile, face / 2, position))
            }
            Face::FreeSlip | Face::Periodic => {
                let mut c = C[OPPOSITE[i]];
                for axis in (0..3).filter(|&axis| crossed[axis].is_some()) {
                    c[axis] = -c[axis];
                }
                Link::Mirror {
                    cell: neighbour,
                    direction: direction(c),
                }
            }
        }
    }

    /// The cell in direction `c` without the components that leave the domain, and the faces through which those leave.
    pub(super) fn walk(
        &self,
        mut position: [usize; 3],
        c: [i32; 3],
    ) -> ([usize; 3], [Option<usize>; 3]) {
        let mut crossed = [None; 3];
        for axis in 0..3 {
            let n = self.cells[axis];
            let (face, at_border) = match c[axis] {
                0 => continue,
                1 => (2 * axis + 1, position[axis] == n - 1),
                _ => (2 * axis, position[axis] == 0),
            };
            if at_border && !matches!(self.faces[face], Face::Periodic) {
                crossed[axis] = Some(face);
            } else {
                position[axis] = (position[axis] + n).wrapping_add_signed(c[axis] as isize) % n;
            }
        }
        (position, crossed)
    }

    fn profile_velocity(&self, profile: &Profile, axis: usize, position: [usize; 3]) -> [f64; 3] {
        match profile {
            Profile::Uniform(velocity) => *velocity,
            Profile::Table(values) => {
                let (fast, slow) = [(1, 2), (0, 2), (0, 1)][axis];
                values[position[fast] + self.cells[fast] * position[slow]]
            }
        }
    }

    /// Links of all cells, 27 per cell; those of solid cells have no meaning.
    pub fn links(&self) -> Vec<[Link; Q]> {
        (0..self.cell_count())
            .map(|cell| std::array::from_fn(|i| self.link(cell, i)))
            .collect()
    }
}

/// Precedence of a face where several meet: the smallest decides.
fn rank(face: &Face) -> u32 {
    match face {
        Face::Velocity(_) => 0,
        Face::Wall([0.0, 0.0, 0.0]) => 1,
        Face::Wall(_) => 2,
        Face::FreeSlip | Face::Periodic => 3,
    }
}
