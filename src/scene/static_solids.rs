//! Static solids on the grid: which cells they fill.
//!
//! A cell is solid if its centre is inside. Surfaces are half-open, like intervals: of two boxes
//! that share a face every centre on that face belongs to exactly one.
//!
//! In a closed mesh the winding number is evaluated in the cells that the surface touches, and once for each
//! connected region of the others: between two neighbours that it does not touch there is no surface.

use glam::DVec3;

use super::{Axis, Domain, Face, Scene, Shape, Solid, solid_fractions::Growth};
use crate::error::{Error, Result};
use crate::geometry::{TriangleMesh, WindingTree};

/// Which cells are solid, x fastest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mask {
    cells: [u32; 3],
    solid: Vec<u8>,
}

impl Mask {
    /// A mask without solid cells, for a grid of `cells` along x, y, z.
    ///
    /// # Errors
    /// If the cells do not fit into memory.
    pub fn new(cells: [u32; 3]) -> Result<Self> {
        let count: u128 = cells.iter().map(|n| u128::from(*n)).product();
        let mut solid = Vec::new();
        let room = usize::try_from(count).ok();
        let room = room.filter(|count| solid.try_reserve_exact(*count).is_ok());
        let Some(room) = room else {
            let message = format!("{count} cells do not fit into memory; use a larger cell");
            return Err(Error::scene("domain.cell", message));
        };
        solid.resize(room, 0);
        Ok(Self { cells, solid })
    }

    /// Number of cells along x, y, z.
    pub fn cells(&self) -> [u32; 3] {
        self.cells
    }

    /// 1 for each solid cell, 0 for each fluid cell, x fastest.
    pub fn as_slice(&self) -> &[u8] {
        &self.solid
    }

    /// Index of the cell `ijk` in [`Self::as_slice`].
    pub fn index(&self, [i, j, k]: [u32; 3]) -> usize {
        let [nx, ny, _] = self.cells.map(|n| n as usize);
        (k as usize * ny + j as usize) * nx + i as usize
    }

    /// Whether the cell `ijk` is on the grid.
    fn has(&self, ijk: [u32; 3]) -> bool {
        (0..3).all(|axis| ijk[axis] < self.cells[axis])
    }

    /// Whether the cell `ijk` is solid; cells outside the grid are not.
    pub fn is_solid(&self, ijk: [u32; 3]) -> bool {
        self.has(ijk) && self.solid[self.index(ijk)] != 0
    }

    /// Makes the cell `ijk` solid or fluid; cells outside the grid are ignored.
    pub fn set(&mut self, ijk: [u32; 3], solid: bool) {
        if self.has(ijk) {
            let index = self.index(ijk);
            self.solid[index] = u8::from(solid);
        }
    }

    /// Number of solid cells.
    pub fn solid_count(&self) -> usize {
        self.solid.iter().filter(|s| **s != 0).count()
    }

    /// The cells next to `face` of the domain, the lower of the two in-plane axes fastest.
    pub fn face_cells(&self, face: Face) -> impl Iterator<Item = [u32; 3]> + use<> {
        let axis = face.axis().index();
        let [fast, slow] = face.axis().others().map(Axis::index);
        let cells = self.cells;
        let layer = if face.is_max() {
            cells[axis].saturating_sub(1)
        } else {
            0
        };
        (0..cells[slow]).flat_map(move |s| {
            (0..cells[fast]).map(move |f| {
                let mut ijk = [layer; 3];
                ijk[fast] = f;
                ijk[slow] = s;
                ijk
            })
        })
    }
}

impl Scene {
    /// The cells that the solids of the scene fill entirely.
    ///
    /// # Errors
    /// The errors of [`Scene::solid_fractions`].
    pub fn solid_mask(&self) -> Result<Mask> {
        Ok(self.solid_fractions()?.mask)
    }

    /// Roughness of each solid cell, m, x fastest; empty if all are smooth.
    ///
    /// # Errors
    /// If the file of a mesh cannot be read, or a mesh is open or lies wholly outside the domain.
    pub fn solid_roughness(&self) -> Result<Vec<f64>> {
        if self.solids.iter().all(|solid| solid.roughness == 0.0) {
            return Ok(Vec::new());
        }
        let mask = Mask::new(self.cells())?;
        let mut roughness = vec![0.0; mask.as_slice().len()];
        self.fill_solids(Growth::default(), |solid, cell, part| {
            if part >= 0.5 && mask.has(cell) {
                roughness[mask.index(cell)] = solid.roughness;
            }
        })?;
        Ok(roughness)
    }

    /// Calls `mark` for each cell whose centre lies in a solid.
    pub(super) fn fill_by_centres(
        &self,
        key: &str,
        solid: &Solid,
        mut mark: impl FnMut([u32; 3]),
    ) -> Result<()> {
        if let Some(mesh) = self.solid_mesh(key, &solid.shape)? {
            cells_in_mesh(&mesh, &self.domain, mark);
        } else if let Some(terrain) = self.terrain(&solid.shape)? {
            let [nx, ny, nz] = self.domain.cells();
            for (i, j) in (0..ny).flat_map(|j| (0..nx).map(move |i| (i, j))) {
                let [x, y, _] = self.domain.centre([i, j, 0]);
                let height = terrain.height(x, y);
                self.check_covered(key, height.is_none().then_some([i, j]))?;
                let below = |k: &u32| height.is_some_and(|h| self.domain.centre([i, j, *k])[2] < h);
                (0..nz).take_while(below).for_each(|k| mark([i, j, k]));
            }
        } else {
            cells_in_shape(&solid.shape, &self.domain, mark);
        }
        Ok(())
    }
}

/// Distance, in cells, within which a centre counts as lying on a surface: above the rounding of decimal coordinates,
/// below any relevant length.
const ON_SURFACE: f64 = 1e-6;

/// Calls `mark` for each cell whose centre lies inside `shape`; for none if it is a mesh or a terrain.
fn cells_in_shape(shape: &Shape, domain: &Domain, mut mark: impl FnMut([u32; 3])) {
    let slack = ON_SURFACE * domain.cell;
    let [nx, ny, nz] = domain.cells();
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                if contains(shape, domain.centre([i, j, k]), slack) {
                    mark([i, j, k]);
                }
            }
        }
    }
}

/// Whether `shape`, other than a mesh or a terrain, contains the point `x` in m; a point within `slack` m of a surface belongs
/// to the side of larger coordinates.
fn contains(shape: &Shape, x: [f64; 3], slack: f64) -> bool {
    match shape {
        Shape::Box { min, max } => (0..3).all(|a| min[a] - slack <= x[a] && x[a] < max[a] - slack),
        Shape::HalfSpace { point, normal } => {
            let normal = DVec3::from(*normal).normalize();
            (DVec3::from(x) - DVec3::from(*point)).dot(normal) < -slack
        }
        Shape::Sphere { center, radius } => {
            DVec3::from(x).distance(DVec3::from(*center)) < radius - slack
        }
        Shape::Mesh { .. } | Shape::Terrain { .. } => false,
    }
}

/// Shift of the points at which the winding number is evaluated, in cells: centres that lie on the surface then
/// belong to the side of larger coordinates. Above the rounding of f32 coordinates (6e-8 of up to 10³ cells).
const SHIFT: f64 = 1e-4;
/// Half the edge of the cube around a cell centre in which the surface is searched, in cells; it contains the shifted
/// lines between neighbours.
const HALF: f64 = 0.5 + 2.0 * SHIFT;

#[derive(Clone, Copy, PartialEq)]
enum State {
    Unknown,
    Touched,
    Done,
}

/// Calls `mark` for each cell whose centre lies inside the closed `mesh`.
fn cells_in_mesh(mesh: &TriangleMesh, domain: &Domain, mut mark: impl FnMut([u32; 3])) {
    let grid = Grid {
        domain,
        cells: domain.cells(),
    };
    let tree = WindingTree::new(mesh);
    let contains = |cell| {
        let centre = DVec3::from(domain.centre(cell)) + DVec3::splat(SHIFT * domain.cell);
        // An inverted mesh has −1 inside.
        tree.at(centre).abs() > 0.5
    };
    let mut state = vec![State::Unknown; domain.cell_count()];
    grid.touch(mesh, &mut state);
    let mut region = Vec::new();
    for seed in 0..state.len() {
        match state[seed] {
            State::Done => {}
            State::Touched => {
                let cell = grid.cell(seed);
                if contains(cell) {
                    mark(cell);
                }
            }
            State::Unknown => {
                let inside = contains(grid.cell(seed));
                state[seed] = State::Done;
                region.push(grid.cell(seed));
                while let Some(cell) = region.pop() {
                    if inside {
                        mark(cell);
                    }
                    grid.neighbours(cell, |next| {
                        let index = grid.index(next);
                        if state[index] == State::Unknown {
                            state[index] = State::Done;
                            region.push(next);
                        }
                    });
                }
            }
        }
    }
}

struct Grid<'a> {
    domain: &'a Domain,
    cells: [u32; 3],
}

impl Grid<'_> {
    fn index(&self, [i, j, k]: [u32; 3]) -> usize {
        let [nx, ny, _] = self.cells.map(|n| n as usize);
        (k as usize * ny + j as usize) * nx + i as usize
    }

    fn cell(&self, index: usize) -> [u32; 3] {
        let [nx, ny, _] = self.cells.map(|n| n as usize);
        [index % nx, index / nx % ny, index / (nx * ny)].map(|i| i as u32)
    }

    fn neighbours(&self, cell: [u32; 3], mut visit: impl FnMut([u32; 3])) {
        for axis in 0..3 {
            let mut next = cell;
            if cell[axis] > 0 {
                next[axis] = cell[axis] - 1;
                visit(next);
            }
            if cell[axis] + 1 < self.cells[axis] {
                next[axis] = cell[axis] + 1;
                visit(next);
            }
        }
    }

    /// Marks the cells that the surface touches.
    fn touch(&self, mesh: &TriangleMesh, state: &mut [State]) {
        let half = HALF * self.domain.cell;
        let origin = DVec3::from(self.domain.origin);
        for triangle in 0..mesh.triangles.len() {
            let corners = mesh.corners(triangle);
            let [a, b, c] = corners.map(|p| (p - origin) / self.domain.cell);
            let low = a.min(b).min(c) - HALF;
            let high = a.max(b).max(c) + HALF;
            // Float to integer casts saturate, so that parts outside the domain drop out.
            let first: [u32; 3] = std::array::from_fn(|n| (low[n] - 0.5).ceil() as u32);
            let last: [u32; 3] = std::array::from_fn(|n| {
                ((high[n] + 0.5).floor().max(0.0) as u32).min(self.cells[n])
            });
            for k in first[2]..last[2] {
                for j in first[1]..last[1] {
                    for i in first[0]..last[0] {
                        let index = self.index([i, j, k]);
                        let centre = DVec3::from(self.domain.centre([i, j, k]));
                        if state[index] != State::Touched && touches(corners, centre, half) {
                            state[index] = State::Touched;
                        }
                    }
                }
            }
        }
    }
}

/// Whether the triangle `corners` touches the cube with half the edge `half` around `centre`, by separating axes
/// (Akenine-Möller 2001).
fn touches(corners: [DVec3; 3], centre: DVec3, half: f64) -> bool {
    let v = corners.map(|c| c - centre);
    let edges = [v[1] - v[0], v[2] - v[1], v[0] - v[2]];
    let apart = |axis: DVec3| {
        let reach = half * axis.abs().element_sum();
        let along = v.map(|c| c.dot(axis));
        let least = along[0].min(along[1]).min(along[2]);
        let most = along[0].max(along[1]).max(along[2]);
        least > reach || most < -reach
    };
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    !(axes.into_iter().any(apart)
        || apart(edges[0].cross(edges[1]))
        || edges
            .iter()
            .any(|e| axes.iter().any(|a| apart(a.cross(*e)))))
}
