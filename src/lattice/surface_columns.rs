//! Exact surfaces of solids at rest as columns of cells: heights, slopes, and what lies beyond the columns at edges.

use super::{Face, Grid, survey::Survey};
use std::collections::{HashMap, HashSet};

/// Largest slope of a face towards the nearest axis.
const LARGEST_SLOPE: f64 = 1.2;
/// Largest sum of the differences of height to the columns on both sides: more at edges.
const FLAT: f64 = 0.2;
/// Full cells lie inside the surface, and their columns reach the edges of a convex solid only up to this distance, cells, on
/// average: with it turned prisms have their area.
const EDGE_DEPTH: f64 = 1.2;
/// Cells beside an edge up to which other solid makes the gap too narrow for a stream, and the first of them that may hold some of
/// the solid with the edge.
const EDGE_GAP: usize = 4;
const EDGE_CELLS: usize = 2;
/// Slope up to which faces at an edge count in part as along the grid.
const SLOPE_OF_EDGES: f64 = 0.2;
/// Cells of a column from the surface to full or empty ones.
const PARTIAL: usize = 4;

/// The solid fractions of a setup.
pub(super) struct Solids<'a> {
    pub survey: &'a Survey<'a>,
    pub fractions: HashMap<u32, f64>,
    /// Fluid cells at plane walls, which have a model of their own.
    pub plane: HashSet<u32>,
}

/// A column of cells at the surface.
#[derive(Clone, Copy, Debug)]
pub(super) enum Column {
    /// Height of the solid above the centre of a cell, in a column that is solid, then cut, then fluid.
    Height(f64),
    /// There are no full cells below.
    Low,
    /// There are no empty cells above, or the column leaves the domain.
    High,
}

impl Column {
    pub fn height(self) -> Option<f64> {
        match self {
            Self::Height(height) => Some(height),
            Self::Low | Self::High => None,
        }
    }
}

/// The surface at a column, along an axis across it.
pub(super) struct Profile {
    /// Slope of the surface, where it is flat.
    pub slope: Option<f64>,
    /// Distance by which the surface is longer than its part in the columns with full cells, cells.
    pub longer: f64,
    /// 1 at the edge of a face along the grid, 0 where there is no edge or the face slopes.
    pub straight: f64,
}

impl Solids<'_> {
    pub fn grid(&self) -> &Grid {
        self.survey.grid
    }

    /// 1 in a full cell.
    pub fn fraction(&self, cell: [u32; 3]) -> f64 {
        if self.survey.is_solid(cell) {
            return 1.0;
        }
        let index = self.grid().index(cell) as u32;
        self.fractions.get(&index).copied().unwrap_or(0.0)
    }

    /// The cell next to one in a direction, in the domain.
    pub fn neighbour(&self, cell: [u32; 3], c: [i32; 3]) -> Option<[u32; 3]> {
        self.survey.neighbour_in_domain(cell, c)
    }

    pub fn step(axis: usize, by: i32) -> [i32; 3] {
        let mut c = [0; 3];
        c[axis] = by;
        c
    }

    /// The same where free-slip faces mirror the domain.
    pub fn mirrored(&self, cell: [u32; 3], c: [i32; 3]) -> Option<[u32; 3]> {
        let free_slip = self.free_slip(cell);
        self.neighbour(
            cell,
            [0, 1, 2].map(|axis| {
                let face = 2 * axis + usize::from(c[axis] > 0);
                if free_slip & 1 << face != 0 {
                    0
                } else {
                    c[axis]
                }
            }),
        )
    }

    /// The faces of a cell that are free-slip faces of the domain, one bit each.
    pub fn free_slip(&self, cell: [u32; 3]) -> u32 {
        let faces = self.survey.setup.faces.as_flattened().iter().enumerate();
        let own = faces.filter(|(face, kind)| {
            let axis = face / 2;
            let border = [0, self.grid().cells[axis] - 1][face % 2];
            **kind == Face::FreeSlip && cell[axis] == border
        });
        own.fold(0, |bits, (face, _)| bits | 1 << face)
    }

    /// The column of a cell along `out`.
    pub fn column(&self, cell: [u32; 3], axis: usize, out: i32) -> Column {
        let mut height = self.fraction(cell) - 0.5;
        for (by, end, without) in [(out, 0.0, Column::High), (-out, 1.0, Column::Low)] {
            let (mut at, mut fraction) = (cell, self.fraction(cell));
            for passed in 0.. {
                if fraction == end {
                    break;
                }
                if passed == PARTIAL {
                    return without;
                }
                let Some(next) = self.neighbour(at, Self::step(axis, by)) else {
                    return Column::High;
                };
                at = next;
                fraction = self.fraction(at);
                height += fraction - end;
            }
        }
        Column::Height(height)
    }

    /// The surface along an axis, from the columns on both sides of one with this height.
    pub fn profile(
        &self,
        cell: [u32; 3],
        (axis, out): (usize, i32),
        height: f64,
        along: usize,
    ) -> Profile {
        let sides = [-1, 1].map(|by| {
            let other = self.mirrored(cell, Self::step(along, by));
            other.map_or(Column::High, |other| self.column(other, axis, out))
        });
        if let [Column::Height(before), Column::Height(after)] = sides {
            let slope = 0.5 * (after - before);
            let is_flat =
                (before + after - 2.0 * height).abs() <= FLAT && slope.abs() < LARGEST_SLOPE;
            let turn = (height - before).atan() - (after - height).atan();
            return Profile {
                slope: is_flat.then_some(slope),
                longer: 2.0 * EDGE_DEPTH * (0.5 * turn).tan(),
                straight: 0.0,
            };
        }
        // At an edge the face is straight if the height does not change towards the other side.
        let heights = sides.into_iter().filter_map(Column::height);
        let changes = heights.map(|other| (other - height).abs());
        let change = changes.fold(f64::INFINITY, f64::min);
        let straight = 1.0 - (change / SLOPE_OF_EDGES).min(1.0);
        let part = |step: [i32; 3]| {
            self.neighbour(cell, step)
                .map_or(0.0, |at| self.fraction(at))
        };
        // Beyond an edge the columns of this face end, and those of the face around it, if fluid lies in front of that one. Along
        // the grid that are the cells that the faces cut, and the side of the cell.
        let beyond = sides.into_iter().zip([-1, 1]).map(|(side, by)| {
            let step = Self::step(along, by);
            let faces = match side {
                Column::Low if self.has_gap(cell, step) => 2.0,
                Column::Low => 1.0,
                Column::Height(_) | Column::High => return 0.0,
            };
            let along_grid = part(step) + (faces - 1.0) * (1.0 + part(Self::step(axis, out)));
            straight * along_grid + (1.0 - straight) * faces * EDGE_DEPTH
        });
        Profile {
            slope: None,
            longer: beyond.sum(),
            straight,
        }
    }

    /// Whether the cells next to an edge hold no other solid.
    fn has_gap(&self, cell: [u32; 3], step: [i32; 3]) -> bool {
        let mut at = cell;
        (1..=EDGE_GAP).all(|k| {
            let Some(next) = self.neighbour(at, step) else {
                return false;
            };
            at = next;
            !self.survey.is_solid(at) && (k <= EDGE_CELLS || self.fraction(at) == 0.0)
        })
    }
}
