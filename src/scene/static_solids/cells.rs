//! Cells inside a closed mesh.
//!
//! The winding number is evaluated in the cells that the surface touches, and once for each
//! connected region of the others: between two neighbours that it does not touch there is no
//! surface.

use glam::DVec3;

use super::overlap::touches;
use crate::{
    geometry::{TriangleMesh, WindingTree},
    scene::Domain,
};

/// Shift of the points at which the winding number is taken, in cells: centres that lie on the
/// surface then belong to the side of larger coordinates. Above the rounding of f32 coordinates
/// (6e-8 of up to 10³ cells).
const SHIFT: f64 = 1e-4;
/// Half the edge of the cube in which a cell looks for the surface, in cells; holds the shifted
/// lines between neighbours.
const HALF: f64 = 0.5 + 2.0 * SHIFT;

#[derive(Clone, Copy, PartialEq)]
enum State {
    Unknown,
    Touched,
    Done,
}

/// Calls `mark` for each cell whose centre lies inside the closed `mesh`.
pub(super) fn inside(mesh: &TriangleMesh, domain: &Domain, mut mark: impl FnMut([u32; 3])) {
    let grid = Grid {
        domain,
        cells: domain.cells(),
    };
    let tree = WindingTree::new(mesh);
    let contains = |cell| {
        let centre = DVec3::from(domain.centre(cell)) + DVec3::splat(SHIFT * domain.cell);
        // A mesh turned inside out has −1 inside.
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
