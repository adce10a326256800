//! The cells of a scene for probes, and trilinear interpolation that accounts for walls, solids and periodic axes.

use crate::scene::{Axis, Boundary, Domain, Face, Scene};

/// Tolerance of positions at cell faces, in cells: decimal numbers in scenes are rounded.
const SLACK: f64 = 1e-6;

/// A scene's grid, its solid cells and its boundaries.
pub(super) struct Cells<'a> {
    pub(super) domain: &'a Domain,
    /// Cells along x, y, z.
    pub(super) counts: [u32; 3],
    /// Which axes are periodic.
    pub(super) periodic: [bool; 3],
    /// Velocity (m/s) of the walls at the lower and the upper end of each axis.
    pub(super) walls: [[Option<[f64; 3]>; 2]; 3],
    /// Gradient of the pressure of the fluid at rest, Pa/m: 0 under an acceleration that is not constant.
    pub(super) gradient: [f64; 3],
    solid: &'a [bool],
}

impl<'a> Cells<'a> {
    pub(super) fn new(scene: &'a Scene, solid: &'a [bool]) -> Self {
        let at = |axis: usize, side: usize| scene.boundaries.face(Face::ALL[2 * axis + side]);
        let wall = |axis, side| match at(axis, side) {
            Boundary::Wall { velocity, .. } => Some(*velocity),
            _ => None,
        };
        Self {
            domain: &scene.domain,
            counts: scene.cells(),
            periodic: [0, 1, 2].map(|axis| *at(axis, 0) == Boundary::Periodic),
            walls: [0, 1, 2].map(|axis| [wall(axis, 0), wall(axis, 1)]),
            gradient: [0, 1, 2].map(|axis| {
                let acceleration = scene.fluid.acceleration[axis].constant();
                scene.fluid.density * acceleration.unwrap_or(0.0)
            }),
            solid,
        }
    }

    /// Index of a cell in an array, x fastest.
    pub(super) fn index(&self, [i, j, k]: [u32; 3]) -> u32 {
        i + self.counts[0] * (j + self.counts[1] * k)
    }

    pub(super) fn is_solid(&self, cell: u32) -> bool {
        self.solid.get(cell as usize).is_some_and(|solid| *solid)
    }

    /// `position` (m) along `axis` in cells, 0 at the centre of the first one.
    pub(super) fn place(&self, axis: usize, position: f64) -> f64 {
        (position - self.domain.origin[axis]) / self.domain.cell - 0.5
    }

    /// The layer of cells around `position` (m) along `axis`; the upper one on the face between two layers.
    pub(super) fn layer(&self, axis: Axis, position: f64) -> u32 {
        let axis = axis.index();
        let place = (self.place(axis, position) + 0.5 + SLACK).max(0.0);
        (place as u32).min(self.counts[axis] - 1)
    }

    /// The cells of the layer `number` along `axis`, the lower of the other axes fastest.
    pub(super) fn of_layer(&self, axis: Axis, number: u32) -> impl Iterator<Item = [u32; 3]> {
        let [fast, slow] = axis.others().map(Axis::index);
        let counts = self.counts;
        (0..counts[slow]).flat_map(move |v| {
            (0..counts[fast]).map(move |u| {
                let mut cell = [number; 3];
                (cell[fast], cell[slow]) = (u, v);
                cell
            })
        })
    }

    /// The cells whose centres lie in a box (m), x fastest.
    pub(super) fn within(&self, min: [f64; 3], max: [f64; 3]) -> impl Iterator<Item = [u32; 3]> {
        let ends = [0, 1, 2].map(|axis| {
            let first = (self.place(axis, min[axis]) - SLACK).ceil().max(0.0);
            let last = (self.place(axis, max[axis]) + SLACK).floor();
            first as u32..(last + 1.0).clamp(0.0, self.counts[axis].into()) as u32
        });
        let [x, y, z] = ends;
        z.flat_map(move |k| {
            let (x, y) = (x.clone(), y.clone());
            y.flat_map(move |j| x.clone().map(move |i| [i, j, k]))
        })
    }

    /// The fluid cells whose centres lie in a box (m).
    pub(super) fn fluid_in(&self, min: [f64; 3], max: [f64; 3]) -> Vec<u32> {
        let cells = self.within(min, max).map(|cell| self.index(cell));
        cells.filter(|cell| !self.is_solid(*cell)).collect()
    }

    /// The cell next to `cell` along `axis`; `None` beyond the domain.
    pub(super) fn neighbour(&self, mut cell: [u32; 3], axis: usize, step: i32) -> Option<u32> {
        let count = i64::from(self.counts[axis]);
        let mut place = i64::from(cell[axis]) + i64::from(step);
        if self.periodic[axis] {
            place = place.rem_euclid(count);
        }
        cell[axis] = u32::try_from(place)
            .ok()
            .filter(|p| i64::from(*p) < count)?;
        Some(self.index(cell))
    }
}

/// The contribution of a cell to the value at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Share {
    /// Index of the cell in an array over the domain.
    pub(super) cell: u32,
    /// Its weight; the weights of a point add up to 1.
    pub(super) weight: f64,
    /// Velocity (m/s) of the wall that replaces the velocity of the cell, if any.
    pub(super) wall: Option<[f64; 3]>,
}

/// Index of a cell along one axis, its weight, and the velocity of the wall that replaces that of the cell.
type Term = (u32, f64, Option<[f64; 3]>);

/// The contributions to the point at `at` (m); empty if only solid cells are around it.
pub(super) fn shares(cells: &Cells<'_>, at: [f64; 3]) -> Vec<Share> {
    let terms = [0, 1, 2].map(|axis| terms(cells, axis, cells.place(axis, at[axis])));
    let mut shares = Vec::new();
    for &(k, z_weight, z_wall) in &terms[2] {
        for &(j, y_weight, y_wall) in &terms[1] {
            for &(i, x_weight, x_wall) in &terms[0] {
                let cell = cells.index([i, j, k]);
                let weight = x_weight * y_weight * z_weight;
                if weight > SLACK && !cells.is_solid(cell) {
                    shares.push(Share {
                        cell,
                        weight,
                        wall: x_wall.or(y_wall).or(z_wall),
                    });
                }
            }
        }
    }
    let total: f64 = shares.iter().map(|share| share.weight).sum();
    for share in &mut shares {
        share.weight /= total;
    }
    shares
}

/// What the fluid at rest adds to the pressure of `shares` at the point at `at` (m), Pa: near walls and solids their mean centre
/// is not the point. 0 along periodic axes.
pub(super) fn weight(cells: &Cells<'_>, at: [f64; 3], shares: &[Share]) -> f64 {
    let [nx, ny, _] = cells.counts;
    let along = |axis: usize| {
        let number = |share: &Share| {
            [
                share.cell % nx,
                share.cell / nx % ny,
                share.cell / (nx * ny),
            ]
        };
        let mean = shares
            .iter()
            .map(|share| share.weight * f64::from(number(share)[axis]));
        let offset = cells.place(axis, at[axis]) - mean.sum::<f64>();
        cells.gradient[axis] * offset * cells.domain.cell
    };
    let bounded = (0..3).filter(|axis| !cells.periodic[*axis]);
    bounded.map(along).sum()
}

/// The two neighbours along `axis` of `place`, a position in cells from the first centre.
fn terms(cells: &Cells<'_>, axis: usize, place: f64) -> [Term; 2] {
    let count = cells.counts[axis];
    let last = f64::from(count - 1);
    let lower = place.floor();
    let part = place - lower;
    if cells.periodic[axis] {
        let wrap = |n: f64| (n as i64).rem_euclid(count.into()) as u32;
        return [
            (wrap(lower), 1.0 - part, None),
            (wrap(lower + 1.0), part, None),
        ];
    }
    // Half a cell lies between the outermost centres and the domain's faces.
    let [low, high] = cells.walls[axis];
    let beyond = |cell: u32, distance: f64, wall: Option<[f64; 3]>| {
        let share = (2.0 * distance).min(1.0);
        [(cell, 1.0 - share, None), (cell, share, wall)]
    };
    if place < 0.0 {
        beyond(0, -place, low)
    } else if place > last {
        beyond(count - 1, place - last, high)
    } else {
        let lower = lower as u32;
        let upper = (lower + 1).min(count - 1);
        [(lower, 1.0 - part, None), (upper, part, None)]
    }
}
