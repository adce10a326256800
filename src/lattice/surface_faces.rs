//! The faces of exact surfaces of solids at rest, such as terrain, where the wall model acts.
//!
//! They do not move and are found once, in f64. [`super::block_friction`] finds those of blocks on the device whenever these have
//! moved.

use super::{C, Face, Grid, WallCell, surface_columns::Solids, survey::Survey, wall_model::Walls};
use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use std::collections::HashMap;

/// Cells of a column from the surface up to the one whose velocity the law reads.
const REACH: usize = 12;
/// Distance of that cell from the face, at least.
const SAMPLE_DISTANCE: f64 = 4.0;
/// Height above the face up to which the eddy viscosity follows from the law.
const NEAR: f64 = 4.5;
/// Ratio of the two largest components towards less solid from which a column may run along the second.
const DIAGONAL: f64 = 0.9;
/// Of equal components that of the first axis is the largest, whatever rounding makes of them.
const EQUAL_AXES: DVec3 = DVec3::new(1.0002, 1.0001, 1.0);
/// Cosine of the slope, 1 : 8, below which the cells that a face cuts have an eddy viscosity, as in front of a face along the grid.
/// Without it they take no momentum from the flow above, and the stress drives them backwards.
const ALONG_GRID: f32 = 0.992;
/// Least height of these cells, for their eddy viscosity.
const LEAST_HEIGHT: f64 = 0.25;
/// The cell is the uppermost full one of its column; the number of cells to the one of the law follows.
pub(super) const TOP: u32 = 8;
const CELLS: u32 = 4;
const FREE_SLIP: u32 = 8;
/// Smallest sum towards less solid: the cells that a surface cuts are at most 1 − 1e-4 full.
const LEAST: f64 = 1e-4;
/// The directions through the six faces of a cell.
const SIDES: u32 = 0x7e;

/// A cell at a sloping face, as `sloping_cell.wgsl` has it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(super) struct SlopingCell {
    /// The face x−, x+, … nearest to the sloping one, whether it is the top of its column, the number of cells to the sample, and the
    /// free-slip faces of the cell.
    pub slope: u32,
    /// Directions from a full cell to cells that are not full, one bit each; 0 in other cells.
    pub open: u32,
    /// Scalar of the cell whose velocity the law reads.
    pub sample: u32,
    /// Its distance from the face, cells.
    pub distance: f32,
    /// Outward normal.
    pub normal: [f32; 3],
    /// Friction velocity.
    pub friction: f32,
    /// Tangential velocity that the law has read, relative to the solid.
    pub u: [f32; 3],
    /// Of a face of a block: its entry among the outer cells of blocks.
    pub outer: u32,
    /// What the populations that leave get, w c·slip, and the sum of this.
    pub slip: [f32; 3],
    pub given: f32,
    /// Area of the face that acts on the cell, in faces of a cell; 0 below the top of a column.
    pub area: f32,
    /// Of what it gives off without momentum along the face, the inverse sum and the direction.
    pub per_sum: f32,
    pub still: [f32; 2],
}

/// A cell of fluid near the surface, as `surface_friction.wgsl` has it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct NearCell {
    /// Its scalar.
    pub scalar: u32,
    /// The nearest face, by its number among the cells.
    pub face: u32,
    /// Distance from it, cells.
    pub distance: f32,
}

/// The faces of exact surfaces where the wall model acts.
#[derive(Debug, Default)]
pub struct SurfaceFaces {
    /// Cells at the surface, with the face opposite to that nearest to the sloping one, so that the layers lead into the fluid.
    pub(super) cells: Vec<WallCell>,
    pub(super) slopes: Vec<SlopingCell>,
    pub(super) near: Vec<NearCell>,
    /// Faces among these: the uppermost full cells of columns.
    pub count: usize,
}

/// A face at a cell.
struct Found {
    slope: SlopingCell,
    /// Cells of the column above with their distances from the face.
    above: Vec<([u32; 3], f64)>,
}

impl Solids<'_> {
    /// The cells that the surface cuts and their full neighbours, in ascending order.
    fn at_surface(&self) -> Vec<[u32; 3]> {
        let [nx, ny, _] = self.grid().cells;
        let mut cells = Vec::new();
        for surface in &self.survey.setup.surface {
            let n = surface.cell;
            let cell = [n % nx, n / nx % ny, n / (nx * ny)];
            let around = C.iter().filter_map(|&c| self.neighbour(cell, c));
            let full = around.filter(|&other| self.survey.is_solid(other));
            cells.extend(std::iter::once(cell).chain(full));
        }
        cells.sort_unstable_by_key(|&cell| self.grid().index(cell));
        cells.dedup();
        cells
    }

    /// Whether a cell lies at a pressure or outflow face. Solids fill whole cells there, and such faces extrapolate the populations of
    /// the cells in front of them.
    fn is_at_outlet(&self, cell: [u32; 3]) -> bool {
        let mut faces = self.survey.setup.faces.as_flattened().iter().enumerate();
        faces.any(|(face, kind)| {
            let border = [0, self.grid().cells[face / 2] - 1][face % 2];
            matches!(kind, Face::Pressure { .. } | Face::Outflow { .. }) && cell[face / 2] == border
        })
    }

    /// Whether a cell of a column at this height above the surface holds no solid that is not of the surface.
    fn is_free(&self, at: [u32; 3], above: f64) -> bool {
        let fraction = self.fraction(at);
        !(above > 2.0 && fraction > 0.0 || above > 0.5 && fraction == 1.0)
    }

    /// The face at a cell that the surface cuts, or that lies full under it.
    fn face(&self, cell: [u32; 3]) -> Option<Found> {
        let own = self.fraction(cell);
        let mut open = 0;
        // Towards less solid, with the weights of Youngs 1984.
        let mut less = DVec3::ZERO;
        for (q, &c) in C.iter().enumerate().skip(1) {
            let other = self.mirrored(cell, c)?;
            if self.is_at_outlet(other) {
                return None;
            }
            let fraction = self.fraction(other);
            let is_plane = self.plane.contains(&(self.grid().index(other) as u32));
            if fraction < 1.0 && !is_plane {
                open |= 1 << q;
            }
            let order: i32 = c.iter().map(|c| c.abs()).sum();
            less -= f64::from(4 >> (order - 1)) * fraction * DVec3::from_array(c.map(f64::from));
        }
        if open == 0 || less.length() < LEAST {
            return None;
        }
        let size = less.abs() * EQUAL_AXES;
        let mut axes = [0, 1, 2];
        axes.sort_by(|&a, &b| size[b].total_cmp(&size[a]));
        let [first, second, _] = axes;
        let other = || (less[second].abs() > DIAGONAL * less[first].abs()).then_some(second);
        let column = |axis| {
            let out = if less[axis] > 0.0 { 1 } else { -1 };
            let height = self.column(cell, axis, out).height()?;
            // No face is nearer than this along the axis.
            let nearest = (SAMPLE_DISTANCE + height).ceil().max(0.0) as u32;
            let mut at = cell;
            let mut is_free = |k: u32| {
                self.neighbour(at, Self::step(axis, out))
                    .is_some_and(|next| {
                        at = next;
                        self.is_free(at, f64::from(k) - height)
                    })
            };
            (1..=nearest)
                .all(&mut is_free)
                .then_some((axis, out, height))
        };
        let (axis, out, height) = column(first).or_else(|| column(other()?))?;
        // At edges, the direction towards less solid.
        let mut normal = less;
        let [a, b] = [(axis + 1) % 3, (axis + 2) % 3];
        let profiles = [a, b].map(|along| self.profile(cell, (axis, out), height, along));
        if let [Some(along_a), Some(along_b)] = [profiles[0].slope, profiles[1].slope] {
            normal[axis] = f64::from(out);
            (normal[a], normal[b]) = (-along_a, -along_b);
        }
        let normal = normal.normalize();
        let rise = normal[axis].abs();
        let is_full = own == 1.0;
        let next = self.neighbour(cell, Self::step(axis, out))?;
        if is_full && self.plane.contains(&(self.grid().index(next) as u32)) {
            return None;
        }
        let top = is_full && self.fraction(next) < 1.0;
        let mut above = Vec::new();
        let mut at = cell;
        for k in 1..=REACH {
            at = self.neighbour(at, Self::step(axis, out))?;
            if !self.is_free(at, k as f64 - height) {
                return None;
            }
            let distance = (k as f64 - height) * rise;
            above.push((at, distance));
            if distance < SAMPLE_DISTANCE {
                continue;
            }
            let face = (2 * axis) as u32 + u32::from(out > 0);
            let straight = profiles[0].straight.max(profiles[1].straight);
            let area = 1.0 / rise + straight * (1.0 - 1.0 / rise);
            let area = area + profiles[0].longer + profiles[1].longer;
            let slope = SlopingCell {
                slope: face
                    | if top { TOP } else { 0 }
                    | (k as u32) << CELLS
                    | self.free_slip(cell) << FREE_SLIP,
                open: if is_full { open } else { 0 },
                sample: self.grid().scalar_of(at),
                distance: distance as f32,
                normal: normal.as_vec3().to_array(),
                area: if top { area.max(0.0) as f32 } else { 0.0 },
                ..SlopingCell::default()
            };
            return Some(Found { slope, above });
        }
        None
    }
}

impl SlopingCell {
    /// The axis nearest to the normal.
    fn axis(&self) -> usize {
        (self.slope & 7) as usize / 2
    }

    /// Number of cells to the one whose velocity the law reads.
    pub fn cells(&self) -> u32 {
        self.slope >> CELLS & 15
    }
}

impl SurfaceFaces {
    /// Those of a setup; none without a wall model on surfaces.
    pub(super) fn new(survey: &Survey<'_>, walls: &Walls) -> Self {
        let (setup, grid) = (survey.setup, survey.grid);
        if !setup.has_surface_friction() {
            return Self::default();
        }
        let index = |wall: &WallCell| grid.index(grid.padded_cell(wall.cell)) as u32;
        let solids = Solids {
            survey,
            fractions: setup
                .surface
                .iter()
                .map(|s| (s.cell, s.fraction.into()))
                .collect(),
            plane: walls.cells.iter().map(index).collect(),
        };
        let mut found = Self::default();
        let mut nearest: HashMap<[u32; 3], (f64, u32)> = HashMap::new();
        for cell in solids.at_surface() {
            let Some(Found { slope, above }) = solids.face(cell) else {
                continue;
            };
            let number = found.cells.len() as u32;
            if slope.slope & TOP != 0 {
                found.count += 1;
                let along_grid = slope.normal[slope.axis()].abs() > ALONG_GRID;
                for (at, y) in above {
                    let fraction = solids.fraction(at);
                    let is_cut = fraction > 0.0 && y <= 1.0;
                    let y = match is_cut && along_grid {
                        true => y.max(LEAST_HEIGHT).max(0.5 * (1.0 - fraction)),
                        false => y,
                    };
                    if y > 0.0 && y < NEAR && (along_grid || !is_cut) {
                        let kept = nearest.entry(at).or_insert((y, number));
                        if y < kept.0 {
                            *kept = (y, number);
                        }
                    }
                }
            }
            let roughness = setup.solid_roughness.get(grid.index(cell));
            found.cells.push(WallCell {
                cell: survey.padded_index(cell),
                face: (slope.slope & 7) ^ 1,
                layers: 0,
                roughness: roughness.copied().unwrap_or(0.0),
            });
            found.slopes.push(slope);
        }
        for at in walls.layer_cells(grid) {
            nearest.remove(&at);
        }
        let near = nearest.into_iter().map(|(at, (distance, face))| NearCell {
            scalar: grid.scalar_of(at),
            face,
            distance: distance as f32,
        });
        found.near = near.collect();
        found.near.sort_unstable_by_key(|near| near.scalar);
        found
    }

    /// Number of faces of walls and solids, of which `all` have fluid in front of them on the grid: the steps of a sloping face count
    /// as its part in each column.
    pub(super) fn area(&self, all: u64) -> u64 {
        let steps = self
            .slopes
            .iter()
            .map(|slope| (slope.open & SIDES).count_ones());
        all - u64::from(steps.sum::<u32>()) + self.count as u64
    }

    /// The fluid cells next to these faces, as indices into an array over the domain.
    pub fn open_cells(&self, grid: &Grid) -> impl Iterator<Item = usize> {
        let each = self.cells.iter().zip(&self.slopes);
        each.flat_map(move |(cell, slope)| {
            let open = (1..27).filter(|q| slope.open & (1 << q) != 0);
            let cells = open.map(move |q| grid.neighbour(grid.padded_cell(cell.cell), C[q]));
            cells
                .filter(|&cell| grid.contains(cell))
                .map(|cell| grid.index(cell))
        })
    }

    /// The cells that the surface cuts, with the normals of their faces.
    pub(super) fn cut(&self) -> impl Iterator<Item = (usize, u32, [f32; 3])> {
        let each = self.cells.iter().zip(&self.slopes).enumerate();
        each.filter(|(_, (_, slope))| slope.open == 0)
            .map(|(n, (cell, slope))| (n, cell.cell, slope.normal))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        gpu::layout::check,
        lattice::{Setup, single_cells},
    };
    use std::mem::offset_of;

    #[test]
    fn cells_have_the_layout_of_the_kernel() {
        let program = single_cells(&Setup::periodic([4; 3], 0.1), 1, "surface_friction");
        let module = program.link().unwrap().module;
        let sloping = [
            ("slope", offset_of!(SlopingCell, slope)),
            ("open", offset_of!(SlopingCell, open)),
            ("sample", offset_of!(SlopingCell, sample)),
            ("distance", offset_of!(SlopingCell, distance)),
            ("normal", offset_of!(SlopingCell, normal)),
            ("friction", offset_of!(SlopingCell, friction)),
            ("u", offset_of!(SlopingCell, u)),
            ("outer", offset_of!(SlopingCell, outer)),
            ("slip", offset_of!(SlopingCell, slip)),
            ("given", offset_of!(SlopingCell, given)),
            ("area", offset_of!(SlopingCell, area)),
            ("per_sum", offset_of!(SlopingCell, per_sum)),
            ("still", offset_of!(SlopingCell, still)),
        ];
        check::<SlopingCell>(&module, "SlopingCell", &sloping).unwrap();
        let near = [
            ("scalar", offset_of!(NearCell, scalar)),
            ("face", offset_of!(NearCell, face)),
            ("distance", offset_of!(NearCell, distance)),
        ];
        check::<NearCell>(&module, "NearCell", &near).unwrap();
    }
}
