//! A wall law on faces of blocks at an angle to the grid.

use super::lattice::{C, Q, W, direction};
use super::wall_model::{norm, share};
use super::{Solid, SolidOperator, Twin};

/// Solid fraction from which a cell counts as full.
const FULL: f64 = 0.999;
/// Slope towards the nearest axis from which there is no face.
const STEEP: f64 = 1.2;
/// Largest second difference of heights on a face.
const FLAT: f64 = 0.2;
/// Cells of a column from the surface to full or empty ones, and to the cell of the law.
const PARTIAL: usize = 4;
const REACH: usize = 12;
/// Ratio of the two largest components towards less solid from which a column may run along the second.
const DIAGONAL: f64 = 0.9;
/// Least distance of that cell from the face.
const DISTANCE: f64 = 4.0;
/// Taper of the mixing length at heights from half a cell on, in steps of a cell.
const TAPER: [f64; 6] = [1.0, 0.75, 0.4, 0.15, 0.0, 0.0];

/// A face near a cell.
#[derive(Clone, Debug)]
struct Sloping {
    normal: [f64; 3],
    /// Axis nearest to the normal.
    axis: usize,
    /// Whether the cell is the uppermost full one of its column.
    top: bool,
    /// Directions to cells that are not full.
    open: Vec<usize>,
    /// Cells of the column above with their distances from the face; the law reads the velocity of the last one.
    above: Vec<(usize, f64)>,
    /// Tangential velocity there relative to the block, and the friction velocity.
    u: [f64; 3],
    friction: f64,
    share: f64,
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

fn c(q: usize) -> [f64; 3] {
    C[q].map(f64::from)
}

impl Twin {
    fn solid_in(&self, cell: usize) -> Solid {
        let own = self.blocks.as_ref().map(|(_, cells)| cells[cell]);
        own.filter(|own| own.shares > 0.0).unwrap_or_default()
    }

    fn diagonal(&self, cell: usize, q: usize) -> usize {
        let (at, n) = (self.domain.position(cell), self.domain.cells);
        let moved = |a: usize| (at[a] + n[a]).wrapping_add_signed(C[q][a] as isize) % n[a];
        self.domain.index([moved(0), moved(1), moved(2)])
    }

    /// Height of the solid above the centre of a cell, where its column is solid, cut cells, and nothing.
    fn height(&self, cell: usize, axis: usize, out: i32) -> Option<f64> {
        let until = |out: i32, end: &dyn Fn(f64) -> bool| {
            let mut step = [0; 3];
            step[axis] = out;
            let mut passed = Vec::new();
            let mut at = cell;
            loop {
                let fraction = self.solid_in(at).fraction;
                passed.push(fraction);
                if end(fraction) {
                    return Some(passed);
                }
                if passed.len() > PARTIAL {
                    return None;
                }
                at = self.diagonal(at, direction(step));
            }
        };
        let up: f64 = until(out, &|e| e == 0.0)?.iter().sum();
        let down = until(-out, &|e| e >= FULL)?;
        Some(up - down[1..].iter().map(|e| 1.0 - e).sum::<f64>() - 0.5)
    }

    fn sloping(&self, cell: usize) -> Option<Sloping> {
        let model = self.wall_model.as_ref().filter(|model| model.on_slopes)?;
        let (operator, _) = self.blocks.as_ref()?;
        let here = self.solid_in(cell);
        let sides = || (0..3).flat_map(|axis| [(axis, -1), (axis, 1)]);
        let inside = |(axis, out)| self.domain.fluid_neighbour(cell, axis, out).is_some();
        if *operator != SolidOperator::Holdych || here.fraction == 0.0 || here.deep || here.shared {
            return None;
        }
        if self.domain.solid[cell] || !sides().all(inside) || self.is_at_aligned_face(cell) {
            return None;
        }
        let mut less = [0.0; 3];
        let mut open = Vec::new();
        for q in 1..Q {
            let other = self.diagonal(cell, q);
            let fraction = self.solid_in(other).fraction;
            if fraction < FULL {
                open.push(q);
            }
            let order: i32 = C[q].iter().map(|c| c.abs()).sum();
            let weight = [4.0, 2.0, 1.0][order as usize - 1];
            (0..3).for_each(|a| less[a] -= weight * fraction * f64::from(C[q][a]));
        }
        if open.is_empty() || norm(less) < 1e-3 {
            return None;
        }
        let mut axes = [0, 1, 2];
        axes.sort_by(|a, b| less[*b].abs().total_cmp(&less[*a].abs()));
        let out_along = |axis: usize| if less[axis] > 0.0 { 1 } else { -1 };
        let column = |axis| Some((axis, self.height(cell, axis, out_along(axis))?));
        let other = || (less[axes[1]].abs() > DIAGONAL * less[axes[0]].abs()).then_some(axes[1]);
        let (axis, height) = column(axes[0]).or_else(|| column(other()?))?;
        let out = out_along(axis);
        let slope = |along: usize| {
            let side = |step| {
                let other = self.domain.fluid_neighbour(cell, along, step)?;
                self.height(other, axis, out)
            };
            let (before, after) = (side(-1)?, side(1)?);
            let slope = 0.5 * (after - before);
            let is_flat = (before + after - 2.0 * height).abs() <= FLAT && slope.abs() < STEEP;
            is_flat.then_some(slope)
        };
        let (first, second) = ((axis + 1) % 3, (axis + 2) % 3);
        // At edges, the direction towards less solid.
        let mut normal = less.map(|part| part / less[axis].abs());
        if let (Some(a), Some(b)) = (slope(first), slope(second)) {
            (normal[first], normal[second]) = (-a, -b);
        }
        let length = norm(normal);
        let normal = normal.map(|n| n / length);
        let next = self.domain.fluid_neighbour(cell, axis, out)?;
        let top = here.fraction >= FULL && self.solid_in(next).fraction < FULL;
        let mut above = Vec::new();
        let mut at = cell;
        for k in 1..=REACH {
            at = self.domain.fluid_neighbour(at, axis, out)?;
            if k as f64 > height + 2.0 && self.solid_in(at).fraction > 0.0 {
                return None;
            }
            let distance = (k as f64 - height) / length;
            above.push((at, distance));
            if distance >= DISTANCE {
                let nu = self.config.nu();
                let water = self.velocity_before_at(at);
                let u = [0, 1, 2].map(|a| water[a] - here.velocity[a]);
                let away = dot(u, normal);
                let u = [0, 1, 2].map(|a| u[a] - away * normal[a]);
                let friction = model.law.stress(norm(u), distance, nu).sqrt();
                return Some(Sloping {
                    normal,
                    axis,
                    top,
                    open,
                    above,
                    u,
                    friction,
                    share: share(friction, nu),
                });
            }
        }
        None
    }

    /// The cells at faces at an angle to the grid where the law acts, with the stress over the density and the share of the law:
    /// the uppermost full cell of each column.
    pub fn sloping_faces(&self) -> Vec<(usize, [f64; 3], f64)> {
        let face = |cell| {
            let face = self.sloping(cell).filter(|face| face.top)?;
            let part = face.friction.powi(2) / norm(face.u).max(1e-30);
            Some((cell, face.u.map(|u| part * u), face.share))
        };
        (0..self.f.len()).filter_map(face).collect()
    }

    /// The share of the law in a full cell at such a face, 0 elsewhere.
    pub(super) fn share_at_slope(&self, cell: usize) -> f64 {
        let full = self.solid_in(cell).fraction >= FULL;
        let face = self.sloping(cell).filter(|_| full);
        face.map_or(0.0, |face| face.share)
    }

    /// Velocity with which a solid changes the momentum of a cell that such a face cuts: tangentially that of the fluid.
    pub(super) fn sliding_velocity(&self, cell: usize, v: [f64; 3]) -> [f64; 3] {
        let cut = self.solid_in(cell).fraction < FULL;
        let Some(face) = self.sloping(cell).filter(|_| cut) else {
            return v;
        };
        let f = &self.f[cell];
        let rho = 1.0 + f.iter().sum::<f64>();
        let u = [0, 1, 2].map(|a| (0..Q).map(|q| c(q)[a] * f[q]).sum::<f64>() / rho - v[a]);
        let away = dot(u, face.normal);
        [0, 1, 2].map(|a| v[a] + face.share * (u[a] - away * face.normal[a]))
    }

    /// What the populations that leave a full cell to the fluid gain: the tangential momentum Σ f* c over the open directions,
    /// relative to the block, becomes that which arrived, its opposite, less the stress of the law.
    pub(super) fn sloping_gain(&self, cell: usize, leaving: &[f64; Q]) -> [f64; Q] {
        let solid = self.solid_in(cell);
        let found = self.sloping(cell).filter(|_| solid.fraction >= FULL);
        let Some(face) = found.filter(|face| face.share > 0.0) else {
            return [0.0; Q];
        };
        let along = {
            let n = face.normal;
            let helper = if n[0].abs() > 0.6 {
                [0.0, 1.0, 0.0]
            } else {
                [1.0, 0.0, 0.0]
            };
            let first = cross(n, helper);
            let first = first.map(|v| v / norm(first));
            [first, cross(n, first)]
        };
        let area = if face.top {
            1.0 / face.normal[face.axis].abs()
        } else {
            0.0
        };
        let stress = area * face.friction.powi(2) / norm(face.u).max(1e-30);
        let wanted = along.map(|t| {
            let relative = |q: &usize| {
                (leaving[*q] - 3.0 * W[*q] * dot(c(*q), solid.velocity)) * dot(c(*q), t)
            };
            -2.0 * face.open.iter().map(relative).sum::<f64>() - stress * dot(face.u, t)
        });
        let element = |a: [f64; 3], b: [f64; 3]| -> f64 {
            let each = |q: &usize| W[*q] * dot(c(*q), a) * dot(c(*q), b);
            face.open.iter().map(each).sum()
        };
        let (a, d) = (element(along[0], along[0]), element(along[1], along[1]));
        let b = element(along[0], along[1]);
        // By the eigenvectors of the symmetric matrix; 1/λ is λ/(λ² + 1e-10).
        let angle = 0.5 * (2.0 * b).atan2(a - d);
        let axes = [[angle.cos(), angle.sin()], [-angle.sin(), angle.cos()]];
        let mut solved = [0.0; 2];
        for [x, y] in axes {
            let lambda = a * x * x + 2.0 * b * x * y + d * y * y;
            let part = (x * wanted[0] + y * wanted[1]) * lambda / (lambda * lambda + 1e-10);
            solved[0] += part * x;
            solved[1] += part * y;
        }
        let m = [0, 1, 2].map(|i| solved[0] * along[0][i] + solved[1] * along[1][i]);
        let limit = (12.0 * norm(face.u) / norm(m).max(1e-30)).min(1.0);
        let gain = |q: usize| W[q] * dot(c(q), m) * face.share * limit;
        std::array::from_fn(|q| if face.open.contains(&q) { gain(q) } else { 0.0 })
    }

    /// Raises the eddy viscosity above such faces to that of the mixing length.
    pub(super) fn add_above_slopes(&self, near_wall: &mut [f64]) {
        let faces = (0..self.f.len()).filter_map(|cell| self.sloping(cell));
        for face in faces.filter(|face| face.top) {
            for (cell, y) in face.above {
                if y > 1.0 || (y > 0.0 && self.solid_in(cell).fraction == 0.0) {
                    let at = (y - 0.5).clamp(0.0, 4.0);
                    let n = at as usize;
                    let taper = TAPER[n] + at.fract() * (TAPER[n + 1] - TAPER[n]);
                    let found = taper * 0.4 * y * face.friction * face.share;
                    near_wall[cell] = near_wall[cell].max(found);
                }
            }
        }
    }
}
