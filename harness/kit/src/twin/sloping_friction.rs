//! A wall law on faces at an angle to the grid: their geometry, and the faces of blocks.

use super::lattice::{C, Q, direction};
use super::sloping_exchange::balance;
use super::wall_model::{norm, share};
use super::{Solid, SolidOperator, Twin};

/// Solid fraction from which a cell counts as full.
const FULL: f64 = 0.999;
/// Slope towards the nearest axis from which there is no face.
const STEEP: f64 = 1.2;
/// Largest second difference of heights on a face.
const FLAT: f64 = 0.2;
/// Distance from convex edges at which columns with full cells end, and the cells beside an edge where solid closes the gap.
const EDGE_DEPTH: f64 = 1.2;
const GAP: usize = 4;
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
pub(super) struct Sloping {
    pub normal: [f64; 3],
    /// Axis nearest to the normal.
    pub axis: usize,
    /// −1 or 1: the direction of the fluid along it.
    pub out: i32,
    /// Whether the cell is the uppermost full one of its column.
    pub top: bool,
    /// Area of the face in this column and, at an edge, beyond it.
    pub area: f64,
    /// Directions to cells that are not full.
    pub open: Vec<usize>,
    /// Cells of the column above with their distances from the face; the law reads the velocity of the last one.
    pub above: Vec<(usize, f64)>,
    /// Tangential velocity there relative to the block, and the friction velocity.
    pub u: [f64; 3],
    pub friction: f64,
    pub share: f64,
    /// The force on the cell that the pressure balances in fluid at rest.
    pub force: [f64; 3],
    /// What full cells of the solid keep of the deviation from its equilibrium.
    pub kept: f64,
}

/// Solids as columns of cells see them: the fraction in a cell, the fraction of a full one, the cell next to one along an axis, if a
/// column may pass through it, and the cell or mirror image in a direction.
pub(super) struct Columns<'a> {
    pub fraction: &'a dyn Fn(usize) -> f64,
    pub full: f64,
    pub step: &'a dyn Fn(usize, usize, i32) -> Option<usize>,
    pub around: &'a dyn Fn(usize, [i32; 3]) -> Option<usize>,
}

/// Why a column has no height.
#[derive(Clone, Copy, Debug, PartialEq)]
enum NoHeight {
    Low,
    High,
}

impl Columns<'_> {
    /// Height of the solid above the centre of a cell, where its column is solid, cut cells, and nothing.
    fn height(&self, cell: usize, axis: usize, out: i32) -> Result<f64, NoHeight> {
        let until = |out: i32, end: &dyn Fn(f64) -> bool| {
            let mut passed = Vec::new();
            let mut at = cell;
            loop {
                let fraction = (self.fraction)(at);
                passed.push(fraction);
                if end(fraction) {
                    return Some(passed);
                }
                if passed.len() > PARTIAL {
                    return None;
                }
                at = (self.step)(at, axis, out)?;
            }
        };
        let up = until(out, &|e| e == 0.0).ok_or(NoHeight::High)?;
        let down = until(-out, &|e| e >= self.full).ok_or(NoHeight::Low)?;
        Ok(up.iter().sum::<f64>() - down[1..].iter().map(|e| 1.0 - e).sum::<f64>() - 0.5)
    }
}

pub(super) fn along(axis: usize, step: i32) -> [i32; 3] {
    let mut c = [0; 3];
    c[axis] = step;
    c
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

pub(super) fn c(q: usize) -> [f64; 3] {
    C[q].map(f64::from)
}

impl Twin {
    pub(super) fn solid_in(&self, cell: usize) -> Solid {
        let own = self.blocks.as_ref().map(|(_, cells)| cells[cell]);
        own.filter(|own| own.shares > 0.0).unwrap_or_default()
    }

    fn diagonal(&self, cell: usize, q: usize) -> usize {
        let (at, n) = (self.domain.position(cell), self.domain.cells);
        let moved = |a: usize| (at[a] + n[a]).wrapping_add_signed(C[q][a] as isize) % n[a];
        self.domain.index([moved(0), moved(1), moved(2)])
    }

    fn sloping(&self, cell: usize) -> Option<Sloping> {
        self.wall_model.as_ref().filter(|model| model.on_slopes)?;
        let (operator, _) = self.blocks.as_ref()?;
        let here = self.solid_in(cell);
        let sides = || (0..3).flat_map(|axis| [(axis, -1), (axis, 1)]);
        let inside = |(axis, out)| self.fluid_beside(cell, axis, out).is_some();
        if *operator != SolidOperator::Holdych || here.fraction == 0.0 || here.deep || here.shared {
            return None;
        }
        if self.domain.solid[cell] || !sides().all(inside) || self.is_at_aligned_face(cell) {
            return None;
        }
        let torus = |at, c| self.diagonal(at, direction(c));
        let around = |at, c| {
            let image = self.mirrored(at, direction(c));
            Some(image.map_or_else(|| torus(at, c), |image| image.0))
        };
        let columns = Columns {
            fraction: &|at| self.solid_in(at).fraction,
            full: FULL,
            step: &|at, axis, out| self.domain.fluid_neighbour(at, axis, out),
            around: &around,
        };
        // Columns of solid pass through every cell.
        let solid = Columns {
            step: &|at, axis, out| Some(torus(at, along(axis, out))),
            ..columns
        };
        let open = |_: usize| true;
        self.face_near(cell, [&columns, &solid], &open, (here.velocity, 0.0))
    }

    /// The face near a cell. `columns`: those of the fluid and of the solid; `open`: whether a cell that is not full counts as open;
    /// `solid`: its velocity and roughness.
    pub(super) fn face_near(
        &self,
        cell: usize,
        [columns, heights]: [&Columns<'_>; 2],
        is_open: &dyn Fn(usize) -> bool,
        (velocity, roughness): ([f64; 3], f64),
    ) -> Option<Sloping> {
        let model = self.wall_model.as_ref()?;
        let here = (columns.fraction)(cell);
        let mut less = [0.0; 3];
        let mut open = Vec::new();
        for q in 1..Q {
            let other = (columns.around)(cell, C[q])?;
            let fraction = (columns.fraction)(other);
            if fraction < columns.full && is_open(other) {
                open.push(q);
            }
            let order: i32 = C[q].iter().map(|c| c.abs()).sum();
            let weight = [4.0, 2.0, 1.0][order as usize - 1];
            (0..3).for_each(|a| less[a] -= weight * fraction * f64::from(C[q][a]));
        }
        if open.is_empty() || norm(less) < 1e-4 {
            return None;
        }
        // Of equal components that of the first axis.
        let size = [0, 1, 2].map(|a| less[a].abs() * (1.0002 - 0.0001 * a as f64));
        let mut axes = [0, 1, 2];
        axes.sort_by(|a, b| size[*b].total_cmp(&size[*a]));
        let [first, second, _] = axes;
        let column = |axis: usize| {
            let out = if less[axis] > 0.0 { 1 } else { -1 };
            let height = heights.height(cell, axis, out).ok()?;
            // No face is nearer than this along the axis.
            let nearest = (DISTANCE + height).ceil().max(0.0) as usize;
            let mut at = cell;
            let mut is_free = |k: usize| {
                (columns.step)(at, axis, out).is_some_and(|next| {
                    at = next;
                    self.is_free(columns, at, k as f64 - height)
                })
            };
            (1..=nearest)
                .all(&mut is_free)
                .then_some((axis, out, height))
        };
        let other = || (less[second].abs() > DIAGONAL * less[first].abs()).then_some(second);
        let (axis, out, height) = column(first).or_else(|| column(other()?))?;
        let beside = |side: usize, step| match (columns.around)(cell, along(side, step)) {
            Some(other) => heights.height(other, axis, out),
            None => Err(NoHeight::High),
        };
        let slope = |side: usize| {
            let (before, after) = (beside(side, -1).ok()?, beside(side, 1).ok()?);
            let slope = 0.5 * (after - before);
            let is_flat = (before + after - 2.0 * height).abs() <= FLAT && slope.abs() < STEEP;
            is_flat.then_some(slope)
        };
        // At the edge of a face along the grid, 1.
        let straight = |side: usize| {
            let sides = [-1, 1].map(|step| beside(side, step).ok());
            match sides {
                [Some(_), Some(_)] | [None, None] => 0.0,
                [a, b] => {
                    let change = a.or(b).map_or(0.0, |other| (other - height).abs());
                    (1.0 - change / 0.2).max(0.0)
                }
            }
        };
        let part = |side: usize, step: i32| {
            (columns.around)(cell, along(side, step)).map_or(0.0, columns.fraction)
        };
        // The part of the surface beyond the columns with full cells: twice where it continues around an edge.
        let beyond = |side: usize, step: i32| {
            let mut at = Some(cell);
            let mut is_free = |k: usize| {
                at = at.and_then(|at| (columns.step)(at, side, step));
                at.is_some_and(|at| {
                    !self.domain.solid[at] && (k <= 2 || (columns.fraction)(at) == 0.0)
                })
            };
            let (oblique, aligned) = match beside(side, step) {
                Err(NoHeight::Low) if (1..=GAP).all(&mut is_free) => {
                    (2.0 * EDGE_DEPTH, part(side, step) + 1.0 + part(axis, out))
                }
                Err(NoHeight::Low) => (EDGE_DEPTH, part(side, step)),
                _ => return 0.0,
            };
            let straight = straight(side);
            straight * aligned + (1.0 - straight) * oblique
        };
        let longer = |side: usize| match (beside(side, -1), beside(side, 1)) {
            (Ok(before), Ok(after)) => {
                let turn = (height - before).atan() - (after - height).atan();
                2.0 * EDGE_DEPTH * (turn / 2.0).tan()
            }
            _ => beyond(side, -1) + beyond(side, 1),
        };
        let (first, second) = ((axis + 1) % 3, (axis + 2) % 3);
        // At edges, the direction towards less solid.
        let mut normal = less.map(|part| part / less[axis].abs());
        if let (Some(a), Some(b)) = (slope(first), slope(second)) {
            (normal[first], normal[second]) = (-a, -b);
        }
        let length = norm(normal);
        let normal = normal.map(|n| n / length);
        let next = (columns.step)(cell, axis, out)?;
        let top = here >= columns.full && (columns.fraction)(next) < columns.full;
        if top && !is_open(next) {
            return None;
        }
        let mut above = Vec::new();
        let mut at = cell;
        for k in 1..=REACH {
            at = (columns.step)(at, axis, out)?;
            let above_face = k as f64 - height;
            if !self.is_free(columns, at, above_face) {
                return None;
            }
            let distance = above_face / length;
            above.push((at, distance));
            if distance >= DISTANCE {
                let nu = self.config.nu();
                let water = self.velocity_before_at(at);
                let u = [0, 1, 2].map(|a| water[a] - velocity[a]);
                let away = dot(u, normal);
                let u = [0, 1, 2].map(|a| u[a] - away * normal[a]);
                let friction = model.rough_stress(norm(u), distance, nu, roughness).sqrt();
                return Some(Sloping {
                    normal,
                    axis,
                    out,
                    top,
                    area: {
                        let straight = straight(first).max(straight(second));
                        let own = straight + (1.0 - straight) * length;
                        (own + longer(first) + longer(second)).max(0.0)
                    },
                    open,
                    above,
                    u,
                    friction,
                    share: share(friction, nu),
                    force: self.balanced_force(cell),
                    kept: 1.0 - velocity.iter().map(|v| v.abs()).sum::<f64>().min(0.9),
                });
            }
        }
        None
    }

    /// Whether a cell of the column at this height above the face holds no solid that is not of the face.
    fn is_free(&self, columns: &Columns<'_>, at: usize, above_face: f64) -> bool {
        let other_solid = above_face > 2.0 && (columns.fraction)(at) > 0.0;
        !other_solid && (above_face <= 0.5 || !self.domain.solid[at])
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
        let momentum = |a: usize| (0..Q).map(|q| c(q)[a] * f[q]).sum::<f64>();
        let u = [0, 1, 2].map(|a| (momentum(a) + 0.5 * face.force[a]) / rho - v[a]);
        let away = dot(u, face.normal);
        [0, 1, 2].map(|a| v[a] + face.share * (u[a] - away * face.normal[a]))
    }

    /// What the populations that leave a full cell to the fluid gain: the tangential momentum Σ f* c over the open directions,
    /// relative to the block, becomes that which arrived, its opposite, less the stress of the law.
    pub(super) fn sloping_gain(&self, cell: usize, leaving: &[f64; Q], balance: f64) -> [f64; Q] {
        let solid = self.solid_in(cell);
        let found = self.sloping(cell).filter(|_| solid.fraction >= FULL);
        found.map_or([0.0; Q], |face| {
            let density = face.density(|at| self.f[at].iter().sum());
            face.gain(face.slip(solid.velocity, leaving, density), balance)
        })
    }

    /// What all full cells give off, over its amount, by the eddy viscosity of each cell.
    pub fn slip_balance(&self, nu_t: &[f64]) -> f64 {
        let full = (0..self.f.len()).filter(|&cell| self.solid_in(cell).fraction >= FULL);
        balance(full.filter_map(|cell| {
            let face = self.sloping(cell)?;
            let leaving = self.collided_in(cell, nu_t[cell]);
            let density = face.density(|at| self.f[at].iter().sum());
            let m = face.slip(self.solid_in(cell).velocity, &leaving, density);
            Some((face.given(m), face.still().is_some()))
        }))
    }

    /// Raises the eddy viscosity above such faces to that of the mixing length.
    pub(super) fn add_above_slopes(&self, near_wall: &mut [f64]) {
        let faces = (0..self.f.len()).filter_map(|cell| self.sloping(cell));
        for face in faces.filter(|face| face.top) {
            for &(cell, y) in &face.above {
                if y > 1.0 || (y > 0.0 && self.solid_in(cell).fraction == 0.0) {
                    near_wall[cell] = near_wall[cell].max(face.viscosity_at(y));
                }
            }
        }
    }
}

impl Sloping {
    /// Eddy viscosity at a distance from the face by the mixing length.
    pub(super) fn viscosity_at(&self, y: f64) -> f64 {
        let at = (y - 0.5).clamp(0.0, 4.0);
        let n = at as usize;
        let taper = TAPER[n] + at.fract() * (TAPER[n + 1] - TAPER[n]);
        taper * 0.4 * y * self.friction * self.share
    }
}
