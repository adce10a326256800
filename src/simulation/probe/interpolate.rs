//! Trilinear interpolation that knows walls, solids and periodic ends.

use super::cells::Cells;

/// A share of a point's value.
#[derive(Clone, Copy, Debug)]
pub(super) struct Share {
    /// Cell that has it: a place in an array over the domain.
    pub(super) cell: u32,
    /// Its weight; those of a point add up to 1.
    pub(super) weight: f64,
    /// Velocity (m/s) of the wall that has this share of the velocity instead of the cell.
    pub(super) wall: Option<[f64; 3]>,
}

/// A cell along one axis, its weight, and the wall that stands in for its velocity.
type Term = (u32, f64, Option<[f64; 3]>);

/// The shares of the point at `at` (m); none if only solid cells are around it.
pub(super) fn shares(cells: &Cells<'_>, at: [f64; 3]) -> Vec<Share> {
    let terms = [0, 1, 2].map(|axis| terms(cells, axis, cells.place(axis, at[axis])));
    let mut shares = Vec::new();
    for &(k, z_weight, z_wall) in &terms[2] {
        for &(j, y_weight, y_wall) in &terms[1] {
            for &(i, x_weight, x_wall) in &terms[0] {
                let cell = cells.index([i, j, k]);
                let weight = x_weight * y_weight * z_weight;
                if weight > 0.0 && !cells.is_solid(cell) {
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

/// The two neighbours along `axis` of a place counted in cells from the first centre.
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
