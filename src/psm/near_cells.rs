//! Convex parts of blocks at their positions, in cells, and the cells in or close to them.

use super::{Frame, Part as Row, frame::whole, tiles::Outline};
use crate::{
    geometry::{Part, Placed, Pose},
    lattice::in_plane,
};
use glam::DVec3;

/// A cell whose centre lies in a part or close to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearCell {
    /// Index in an array over the domain, x fastest.
    pub index: u32,
    /// Distance of its centre from the part, cells; negative inside. Beyond an edge or a corner the
    /// distance from the nearest plane, which is smaller.
    pub distance: f64,
    /// Outward normal there.
    pub normal: DVec3,
}

impl NearCell {
    /// Its indices along x, y and z in a lattice of `cells`.
    pub fn ijk(&self, [nx, ny, _]: [u32; 3]) -> [u32; 3] {
        let at = self.index;
        [at % nx, at / nx % ny, at / (nx * ny)]
    }
}

/// The cells of a domain of `cells` cells that lie at most `reach` cells from a part, those of its periodic
/// images included where an axis is periodic.
pub fn near_cells(
    outline: &Outline,
    reach: f64,
    cells: [u32; 3],
    periodic: [bool; 3],
    found: &mut Vec<NearCell>,
) {
    let [y, z] = [1, 2].map(|axis| reached(outline, reach, cells, periodic, axis));
    let (ny, nz) = (i64::from(cells[1]), i64::from(cells[2]));
    for &z in &z {
        for &y in &y {
            let Some((from, to)) = row(outline, reach, y, z) else {
                continue;
            };
            for x in inside(from, to, cells[0], periodic[0]) {
                let middle = DVec3::new(x as f64, y as f64, z as f64) + 0.5;
                let (distance, normal) = height(outline, middle - outline.centre);
                let at = [
                    x.rem_euclid(cells[0].into()),
                    y.rem_euclid(ny),
                    z.rem_euclid(nz),
                ];
                found.push(NearCell {
                    index: (at[0] + i64::from(cells[0]) * (at[1] + ny * at[2])) as u32,
                    distance,
                    normal,
                });
            }
        }
    }
}

/// Indices of the cells on an axis in the box of a part grown by `reach`.
fn reached(
    outline: &Outline,
    reach: f64,
    cells: [u32; 3],
    periodic: [bool; 3],
    axis: usize,
) -> Vec<i64> {
    let low = outline.centre[axis] + outline.low[axis] - reach;
    let high = outline.centre[axis] + outline.high[axis] + reach;
    inside(low, high, cells[axis], periodic[axis]).collect()
}

/// Indices of the cells of an axis whose centres lie between two coordinates, beyond the domain only if the axis is
/// periodic.
fn inside(low: f64, high: f64, cells: u32, periodic: bool) -> std::ops::RangeInclusive<i64> {
    let (first, last) = ((low - 0.5).ceil() as i64, (high - 0.5).floor() as i64);
    match periodic {
        true => first..=last,
        false => first.max(0)..=last.min(i64::from(cells) - 1),
    }
}

/// The range of the row of cells through `y` and `z` at most `reach` from a part.
fn row(outline: &Outline, reach: f64, y: i64, z: i64) -> Option<(f64, f64)> {
    let (b, c) = in_plane(0);
    let mut at = DVec3::ZERO;
    at[b] = y as f64 + 0.5 - outline.centre[b];
    at[c] = z as f64 + 0.5 - outline.centre[c];
    let (mut from, mut to) = (outline.low.x - reach, outline.high.x + reach);
    if outline.faces.is_empty() {
        let half = (outline.radius + reach).powi(2) - at.length_squared();
        let half = (half >= 0.0).then(|| half.sqrt())?;
        (from, to) = (-half, half);
    }
    for (normal, distance) in &outline.faces {
        let left = distance + reach - normal.dot(at);
        if normal.x > 0.0 {
            to = to.min(left / normal.x);
        } else if normal.x < 0.0 {
            from = from.max(left / normal.x);
        } else if left < 0.0 {
            return None;
        }
    }
    (from <= to).then_some((from + outline.centre.x, to + outline.centre.x))
}

/// Distance of a point from a part, and the normal there.
fn height(outline: &Outline, point: DVec3) -> (f64, DVec3) {
    if outline.faces.is_empty() {
        let length = point.length();
        let normal = point.try_normalize().unwrap_or(DVec3::X);
        return (length - outline.radius, normal);
    }
    let faces = outline.faces.iter();
    faces
        .map(|(normal, distance)| (normal.dot(point) - distance, *normal))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .unwrap_or((f64::INFINITY, DVec3::X))
}

/// A part of a shape at a pose.
pub fn outline(frame: &Frame, part: &Part, pose: &Pose) -> Outline {
    let cell = frame.units.cell;
    let placed = Placed::of(part, pose);
    let centre = frame.place(placed.centre);
    if placed.faces.is_empty() {
        let radius = placed.radius / cell;
        return Outline {
            centre,
            low: DVec3::splat(-radius),
            high: DVec3::splat(radius),
            radius,
            ..Outline::default()
        };
    }
    let (mut low, mut high) = (DVec3::ZERO, DVec3::ZERO);
    for corner in placed.vertices.iter().map(|v| *v / cell) {
        low = low.min(corner);
        high = high.max(corner);
    }
    let faces = placed.faces.iter();
    Outline {
        centre,
        low,
        high,
        faces: faces
            .map(|face| (face.normal, face.distance / cell))
            .collect(),
        radius: 0.0,
    }
}

/// The row of a part on the device, and its faces.
pub fn rows(outline: &Outline, block: u32, first_face: u32) -> (Row, Vec<[f32; 4]>) {
    let base = outline.centre.floor();
    let faces = outline.faces.iter().map(|(normal, distance)| {
        let [x, y, z] = normal.as_vec3().to_array();
        [x, y, z, *distance as f32]
    });
    let part = Row {
        base: whole(base),
        first_face,
        fraction: (outline.centre - base).as_vec3().to_array(),
        faces: outline.faces.len() as u32,
        low: outline.low.as_vec3().to_array(),
        radius: outline.radius as f32,
        high: outline.high.as_vec3().to_array(),
        block,
    };
    (part, faces.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells_of(outline: &Outline, reach: f64, periodic: [bool; 3]) -> Vec<NearCell> {
        let mut found = Vec::new();
        near_cells(outline, reach, [12, 10, 8], periodic, &mut found);
        found
    }

    fn cube(centre: DVec3, half: f64) -> Outline {
        let axes = [DVec3::X, DVec3::Y, DVec3::Z];
        Outline {
            centre,
            low: DVec3::splat(-half),
            high: DVec3::splat(half),
            faces: axes.iter().flat_map(|n| [(*n, half), (-n, half)]).collect(),
            radius: 0.0,
        }
    }

    #[test]
    fn a_cube_covers_its_cells_and_reaches_those_around_it() {
        let cube = cube(DVec3::splat(4.0), 2.0);
        let covered = cells_of(&cube, 0.0, [false; 3]);
        assert_eq!(covered.len(), 4 * 4 * 4);
        assert!(covered.iter().all(|near| near.distance <= -0.5));
        let around = cells_of(&cube, 1.0, [false; 3]);
        assert_eq!(around.len(), 6 * 6 * 6);
        let outside: Vec<_> = around.iter().filter(|near| near.distance > 0.0).collect();
        assert_eq!(outside.len(), 6 * 6 * 6 - 4 * 4 * 4);
        assert!(outside.iter().all(|near| near.distance == 0.5));
    }

    #[test]
    fn what_leaves_a_periodic_domain_comes_in_on_the_other_side() {
        let cube = cube(DVec3::new(0.0, 4.0, 4.0), 2.0);
        assert_eq!(cells_of(&cube, 0.0, [false; 3]).len(), 2 * 4 * 4);
        let both = cells_of(&cube, 0.0, [true, false, false]);
        assert_eq!(both.len(), 4 * 4 * 4);
        let x: Vec<u32> = both[..4].iter().map(|near| near.index % 12).collect();
        assert_eq!(x, [10, 11, 0, 1]);
    }

    #[test]
    fn a_sphere_covers_what_lies_within_its_radius() {
        let centre = DVec3::new(5.3, 4.9, 4.1);
        let sphere = Outline {
            centre,
            low: DVec3::splat(-2.7),
            high: DVec3::splat(2.7),
            radius: 2.7,
            ..Outline::default()
        };
        let covered = cells_of(&sphere, 0.0, [false; 3]);
        let all = (0..12 * 10 * 8).filter(|at| {
            let cell = DVec3::new(
                f64::from(at % 12),
                f64::from(at / 12 % 10),
                f64::from(at / 120),
            );
            (cell + 0.5 - centre).length() <= 2.7
        });
        let cells: Vec<u32> = covered.iter().map(|near| near.index).collect();
        assert_eq!(cells, all.collect::<Vec<_>>());
    }
}
