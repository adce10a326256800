//! A wall law on exact surfaces of solids at rest.

use super::Twin;
use super::lattice::{C, Q, direction};
use super::sloping_exchange::balance;
use super::sloping_friction::{Columns, Sloping, along, c, dot};
use super::wall_model::norm;
use std::collections::{HashMap, HashSet};

impl Twin {
    /// Fraction of a cell that solids at rest fill.
    fn at_rest(&self, cell: usize) -> f64 {
        match self.domain.solid[cell] {
            true => 1.0,
            false => {
                let model = self.wall_model.as_ref();
                let fraction = model.and_then(|model| model.surface.get(cell));
                fraction.copied().unwrap_or(0.0)
            }
        }
    }

    /// The face of an exact surface at a cell that it cuts, or that is full and touches such a cell; no law acts with a block in the
    /// five cells of the column from this one on.
    fn face_at_rest(
        &self,
        cell: usize,
        plane: &HashSet<usize>,
        blocks: &[bool],
    ) -> Option<Sloping> {
        let step = |at: usize, axis: usize, out: i32| self.inside(at, along(axis, out));
        let around = |at: usize, c: [i32; 3]| Some(self.mirrored(at, direction(c))?.0);
        let columns = Columns {
            fraction: &|at| self.at_rest(at),
            full: 1.0,
            step: &step,
            around: &around,
        };
        let is_cut = |at: usize| (self.at_rest(at) % 1.0) > 0.0;
        let near_cut = C.iter().filter_map(|&c| around(cell, c)).any(is_cut);
        let is_full = self.domain.solid[cell] && near_cut;
        if !is_cut(cell) && !is_full {
            return None;
        }
        let model = self.wall_model.as_ref()?;
        let roughness = model.solid_roughness.get(cell).copied().unwrap_or(0.0);
        let open = |at: usize| !plane.contains(&at);
        let solid = ([0.0; 3], f64::from(roughness));
        let mut face = self.face_near(cell, [&columns; 2], &open, solid)?;
        let mut at = Some(cell);
        for _ in 0..5 {
            if at.is_some_and(|at| blocks.get(at) == Some(&true)) {
                face.share = 0.0;
            }
            at = step(at?, face.axis, face.out);
        }
        Some(face)
    }

    /// Whether such faces may exist, with the fluid cells at plane walls, which have a model of their own.
    fn plane_cells(&self) -> Option<HashSet<usize>> {
        let model = self.wall_model.as_ref().filter(|model| model.on_surfaces)?;
        Some(model.plane_cells(&self.domain).collect())
    }

    /// All such faces that a filter selects, by the blocks in the previous step.
    fn faces_at_rest(&self, full: bool) -> Vec<(usize, Sloping)> {
        let Some(plane) = self.plane_cells() else {
            return Vec::new();
        };
        let blocks = &self.blocks_before;
        let cells = (0..self.f.len()).filter(|&cell| self.domain.solid[cell] || !full);
        cells
            .filter_map(|cell| Some((cell, self.face_at_rest(cell, &plane, blocks)?)))
            .collect()
    }

    /// The uppermost full cells of the columns at such faces, with the stress over the density and the share of the law.
    pub fn surface_faces(&self) -> Vec<(usize, [f64; 3], f64)> {
        let tops = self.faces_at_rest(true).into_iter();
        tops.filter(|(_, face)| face.top)
            .map(|(cell, face)| {
                let part = face.friction.powi(2) / norm(face.u).max(1e-30);
                (cell, face.u.map(|u| part * u), face.share)
            })
            .collect()
    }

    /// Sets the eddy viscosity near such faces where no wall has set it: by the nearest face.
    pub(super) fn add_above_surface(&self, near_wall: &mut [f64]) {
        let mut nearest: HashMap<usize, (f64, f64)> = HashMap::new();
        for (_, face) in self.faces_at_rest(true) {
            for &(cell, y) in face.above.iter().filter(|_| face.top) {
                let fraction = self.at_rest(cell);
                let mut height = y;
                if fraction > 0.0 && y <= 1.0 {
                    if face.normal[face.axis].abs() <= 0.992 {
                        continue;
                    }
                    height = y.max(0.25).max((1.0 - fraction) / 2.0);
                }
                if height > 0.0 && height < 4.5 {
                    let found = (height, face.viscosity_at(height));
                    let kept = nearest.entry(cell).or_insert(found);
                    if height < kept.0 {
                        *kept = found;
                    }
                }
            }
        }
        let model = self.wall_model.as_ref();
        let walls = model.map(|model| model.cells_near_walls(&self.domain));
        for (cell, (_, viscosity)) in nearest {
            if walls.as_ref().is_some_and(|walls| !walls.contains(&cell)) {
                near_wall[cell] = viscosity;
            }
        }
    }

    /// Applies the stress to the populations that full cells have returned.
    pub(super) fn exchange_at_surface(&mut self) {
        let faces = self.faces_at_rest(true).into_iter().map(|(cell, face)| {
            let open = face.open.iter();
            let returned: Vec<_> = open
                .filter_map(|&q| Some((q, self.mirrored(cell, q)?)))
                .collect();
            let mut leaving = [0.0; Q];
            for &(q, (other, reflected)) in &returned {
                leaving[q] = self.f[other][reflected];
            }
            let density = face.density(|at| self.previous_density[at]);
            let slip = face.slip([0.0; 3], &leaving, density);
            (face, returned, slip)
        });
        let faces: Vec<_> = faces.collect();
        let given =
            |(face, _, slip): &(Sloping, _, [f64; 3])| (face.given(*slip), face.still().is_some());
        let balance = balance(faces.iter().map(given));
        for (face, returned, slip) in faces {
            let gain = face.gain(slip, balance);
            for (q, (other, reflected)) in returned {
                self.f[other][reflected] += gain[q];
            }
        }
    }

    /// The velocity of the solid for a cell without block that such a face cuts.
    pub(super) fn velocity_at_surface(&self, cell: usize) -> [f64; 3] {
        let face = || {
            let blocks = self.blocks.as_ref().map(|(_, cells)| cells);
            let blocks: Vec<bool> = blocks?.iter().map(|cell| cell.shares > 0.0).collect();
            self.face_at_rest(cell, &self.plane_cells()?, &blocks)
        };
        let is_cut = self.at_rest(cell) > 0.0 && !self.domain.solid[cell];
        let Some(face) = is_cut.then(face).flatten() else {
            return [0.0; 3];
        };
        let f = &self.f[cell];
        let rho = 1.0 + f.iter().sum::<f64>();
        let momentum = |a: usize| (0..Q).map(|q| c(q)[a] * f[q]).sum::<f64>();
        let u = [0, 1, 2].map(|a| (momentum(a) + 0.5 * face.force[a]) / rho);
        let away = dot(u, face.normal);
        [0, 1, 2].map(|a| face.share * (u[a] - away * face.normal[a]))
    }

    /// The cell in a direction, or that of which it is the mirror image beyond a free-slip face, and the reflected direction; none
    /// beyond other faces.
    pub(super) fn mirrored(&self, cell: usize, q: usize) -> Option<(usize, usize)> {
        let (to, crossed) = self.domain.walk(self.domain.position(cell), C[q]);
        let mut reflected = C[q];
        for (axis, face) in crossed.into_iter().enumerate() {
            if let Some(face) = face {
                if !matches!(self.domain.faces[face], super::domain::Face::FreeSlip) {
                    return None;
                }
                reflected[axis] = -reflected[axis];
            }
        }
        Some((self.domain.index(to), direction(reflected)))
    }

    /// The cell next to one, across periodic faces too; none outside the domain.
    fn inside(&self, cell: usize, c: [i32; 3]) -> Option<usize> {
        let (at, n) = (self.domain.position(cell), self.domain.cells);
        let mut to = at;
        for a in 0..3 {
            let moved = at[a] as i32 + c[a];
            let leaves = !(0..n[a] as i32).contains(&moved);
            if leaves && !matches!(self.domain.faces[2 * a], super::domain::Face::Periodic) {
                return None;
            }
            to[a] = moved.rem_euclid(n[a] as i32) as usize;
        }
        Some(self.domain.index(to))
    }
}
