//! A wall law instead of no slip on faces of blocks parallel to the grid.

use super::lattice::{C, Q, W, direction, macroscopic};
use super::sloping_friction::along;
use super::wall_model::{norm, share};
use super::{Solid, Twin};

/// Cells of fluid in front of a face; the law reads the velocity of the last one.
const DEPTH: usize = 5;
/// Solid fraction from which a cell counts as full.
const FULL: f64 = 0.999;
/// Largest difference of solid fractions along a face.
const SLOPE: f64 = 0.1;
/// Taper of the mixing length at heights from half a cell on, in steps of a cell.
const TAPER: [f64; 6] = [1.0, 0.75, 0.4, 0.15, 0.0, 0.0];

/// A face of a block: one of the faces of a full cell.
#[derive(Clone, Copy, Debug)]
struct BlockFace {
    cell: usize,
    axis: usize,
    /// −1 or 1: the direction of the fluid.
    out: i32,
}

/// Friction on a face by the law.
#[derive(Clone, Copy, Debug)]
struct Friction {
    face: BlockFace,
    /// Stress along the face over the density.
    stress: [f64; 3],
    friction: f64,
    /// Share of the law: 0 for no slip, 1 for the law alone.
    share: f64,
}

impl Twin {
    fn block_at(&self, cell: usize) -> Solid {
        let own = self.blocks.as_ref().map(|(_, cells)| cells[cell]);
        own.filter(|own| own.shares > 0.0).unwrap_or_default()
    }

    /// Solid fraction of the neighbour in a direction; 0 if it is not fluid.
    fn fraction_of(&self, cell: usize, axis: usize, out: i32) -> f64 {
        let other = self.fluid_beside(cell, axis, out);
        other.map_or(0.0, |other| self.block_at(other).fraction)
    }

    /// The fluid cell in a direction, or its mirror image at a free-slip face, the cell itself.
    pub(super) fn fluid_beside(&self, cell: usize, axis: usize, out: i32) -> Option<usize> {
        let q = direction(along(axis, out));
        match self.mirrored(cell, q) {
            Some((_, reflected)) if reflected != q => Some(cell),
            _ => self.domain.fluid_neighbour(cell, axis, out),
        }
    }

    /// The face of a full cell, if the law acts on it.
    fn face_of_block(&self, cell: usize) -> Option<BlockFace> {
        let here = self.block_at(cell);
        let sides = || (0..3).flat_map(|axis| [(axis, -1), (axis, 1)]);
        let inside = |(axis, out)| self.fluid_beside(cell, axis, out).is_some();
        if here.fraction < FULL || here.deep || here.shared || !sides().all(inside) {
            return None;
        }
        let mut open = sides().filter(|(axis, out)| self.fraction_of(cell, *axis, *out) < FULL);
        let (Some((axis, out)), None) = (open.next(), open.next()) else {
            return None;
        };
        let mut at = self.domain.fluid_neighbour(cell, axis, out)?;
        let before = self.block_at(at);
        let differs = |(side, way): (usize, i32)| {
            side != axis && (self.fraction_of(at, side, way) - before.fraction).abs() > SLOPE
        };
        if before.shared || sides().any(differs) {
            return None;
        }
        for _ in 1..DEPTH {
            at = self.domain.fluid_neighbour(at, axis, out)?;
            if self.block_at(at).fraction > 0.0 {
                return None;
            }
        }
        Some(BlockFace { cell, axis, out })
    }

    /// The cells in front of a face, with their heights above it.
    fn cells_before(&self, face: BlockFace) -> [(usize, f64); DEPTH] {
        let (mut at, mut fraction) = (face.cell, 0.0);
        std::array::from_fn(|k| {
            let next = self.domain.fluid_neighbour(at, face.axis, face.out);
            at = next.expect("five cells are fluid");
            if k == 0 {
                fraction = self.block_at(at).fraction;
                return (at, (0.5 * (1.0 - fraction)).max(0.25));
            }
            (at, k as f64 + 0.5 - fraction)
        })
    }

    fn friction_under(&self, face: BlockFace) -> Option<Friction> {
        let (model, nu) = (self.wall_model.as_ref()?, self.config.nu());
        let (sample, y) = self.cells_before(face)[DEPTH - 1];
        let block = self.block_at(face.cell).velocity;
        let water = self.velocity_before_at(sample);
        let mut u = [0, 1, 2].map(|a| water[a] - block[a]);
        u[face.axis] = 0.0;
        let size = model.law.stress(norm(u), y, nu);
        Some(Friction {
            face,
            stress: u.map(|u_a| size * u_a / norm(u).max(1e-30)),
            friction: size.sqrt(),
            share: share(size.sqrt(), nu),
        })
    }

    /// The friction on the face of a full cell.
    fn friction_in(&self, cell: usize) -> Option<Friction> {
        self.wall_model.as_ref().filter(|model| model.on_blocks)?;
        self.friction_under(self.face_of_block(cell)?)
    }

    /// The cells under faces of blocks where the law acts, with its stress over the density and its share.
    pub fn block_faces(&self) -> Vec<(usize, [f64; 3], f64)> {
        let faces = (0..self.f.len()).filter_map(|cell| self.friction_in(cell));
        let of = |law: Friction| (law.face.cell, law.stress, law.share);
        faces.map(of).collect()
    }

    /// Whether a cell is under such a face, or cut by one.
    pub(super) fn is_at_aligned_face(&self, cell: usize) -> bool {
        self.friction_in(cell).is_some() || self.face_that_cuts(cell).is_some()
    }

    /// The friction on the face that cuts a cell.
    fn face_that_cuts(&self, cell: usize) -> Option<Friction> {
        let fraction = self.block_at(cell).fraction;
        let faces = (0..3).flat_map(|axis| [(axis, -1), (axis, 1)]);
        let mut behind = faces.filter_map(|(axis, out)| {
            let solid = self.domain.fluid_neighbour(cell, axis, -out)?;
            let law = self.friction_in(solid)?;
            (law.face.axis == axis && law.face.out == out).then_some(law)
        });
        behind.next().filter(|_| fraction > 0.0 && fraction < FULL)
    }

    /// The share of the law in a full cell at a face where it acts, else 0.
    pub(super) fn part_of_law(&self, cell: usize) -> f64 {
        match self.friction_in(cell) {
            Some(law) => law.share,
            None => self.share_at_slope(cell),
        }
    }

    /// Adds the stress of the law to the change by the solid in a cell, where the block moves with `v`. In the cell under a face,
    /// of the momentum P along it that arrives P − τ returns, and the other directions leave with ρ v; a cell that the face
    /// cuts exchanges none. In fluid at rest under the force F that the pressure balances, P is −F/12 and F/12 has to return; a cell
    /// that is cut has −F/2 before the collision and F/2 after it.
    pub(super) fn apply_wall_stress(&self, cell: usize, v: [f64; 3], change: &mut [f64; Q]) {
        let own = self.friction_in(cell);
        let Some(law) = own.or_else(|| self.face_that_cuts(cell)) else {
            return;
        };
        let (n, f) = (law.face.axis, self.f[cell]);
        let force = self.balanced_force(cell);
        let rho = macroscopic(&f, [0.0; 3]).0;
        let along_n = |i: usize| C[i][n] * law.face.out;
        for t in (0..3).filter(|t| *t != n) {
            let c = |i: usize| f64::from(C[i][t]);
            let sum = |of: &dyn Fn(usize) -> f64| (0..Q).map(|i| c(i) * of(i)).sum::<f64>();
            // Momentum of the directions with c_n = −1, 0, 1, after the change.
            let now = [-1, 0, 1]
                .map(|side| sum(&|i| f64::from(u8::from(along_n(i) == side)) * (f[i] + change[i])));
            let arriving = sum(&|i| f64::from(u8::from(along_n(i) == -1)) * f[i]);
            let wanted = match own {
                Some(_) => [
                    rho * v[t] / 6.0,
                    rho * v[t] / 1.5,
                    arriving - law.stress[t] + force[t] / 6.0,
                ],
                None => {
                    // Distributed over all directions by their weights.
                    let all: f64 = now.iter().sum();
                    let before = sum(&|i| f[i]);
                    [6.0, 1.5, 6.0].map(|part| (before + force[t] - all) / part)
                }
            };
            let add: [f64; 3] = std::array::from_fn(|side| {
                law.share * (wanted[side] - if own.is_some() { now[side] } else { 0.0 })
            });
            for (i, change) in change.iter_mut().enumerate() {
                // Σ w c_t² over the directions of a side is a third of its weight.
                let weight = [6.0, 1.5, 6.0][(along_n(i) + 1) as usize];
                *change += 3.0 * weight * W[i] * c(i) * add[(along_n(i) + 1) as usize];
            }
        }
    }

    /// Raises the eddy viscosity of the cells in front of faces of blocks to that of the mixing length.
    pub(super) fn add_near_blocks(&self, near_wall: &mut [f64]) {
        for law in (0..self.f.len()).filter_map(|cell| self.friction_in(cell)) {
            for (cell, y) in self.cells_before(law.face) {
                let (n, part) = ((y - 0.5).max(0.0) as usize, (y - 0.5).max(0.0).fract());
                let taper = TAPER[n] + part * (TAPER[n + 1] - TAPER[n]);
                let found = taper * 0.4 * y * law.friction * law.share;
                near_wall[cell] = near_wall[cell].max(found);
            }
        }
    }
}
