//! Faces of a solid, and where best to divide it.

use super::HalfSpace;
use crate::geometry::TriangleMesh;
use glam::DVec3;

/// Faces whose planes are tried for a cut, and by which cuts are judged.
const FACES: usize = 48;

/// Corners by which cuts are judged.
const CORNERS: usize = 192;

/// Thickness of a triangle, in roundings, from which its plane is known well enough to cut by.
const BROAD: f64 = 100.0;

/// A piece of a face.
#[derive(Clone)]
pub(super) struct Polygon {
    pub plane: HalfSpace,
    pub corners: Vec<DVec3>,
    /// Whether its plane is known well.
    pub broad: bool,
}

impl Polygon {
    /// The triangles of a mesh, but for those without area.
    pub fn all(mesh: &TriangleMesh, tolerance: f64) -> Vec<Self> {
        let polygon = |index: usize| {
            let [a, b, c] = mesh.corners(index);
            let twice = (b - a).cross(c - a);
            let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
            Some(Self {
                plane: HalfSpace::through((a + b + c) / 3.0, twice.try_normalize()?),
                corners: vec![a, b, c],
                broad: twice.length() > BROAD * tolerance * longest,
            })
        };
        (0..mesh.triangles.len()).filter_map(polygon).collect()
    }

    /// Whether a corner is higher than `height` (m) above `plane`.
    pub fn rises(&self, plane: &HalfSpace, height: f64) -> bool {
        self.corners.iter().any(|c| plane.height(*c) > height)
    }
}

/// A plane that divides what is not convex: of all that are tried, the one that leaves the least height of
/// corners above faces on its own sides. None if no face has corners more than `deviation` (m) above it.
pub(super) fn best_cut(polygons: &[Polygon], deviation: f64, tolerance: f64) -> Option<HalfSpace> {
    let concave = |p: &&Polygon| p.broad && polygons.iter().any(|o| o.rises(&p.plane, deviation));
    // Some faces here and there; all of them only if none of those will do.
    let mut faces: Vec<&Polygon> = some(polygons, 4 * FACES).filter(concave).collect();
    if faces.is_empty() {
        faces = polygons.iter().filter(concave).collect();
    }
    let faces: Vec<&Polygon> = some(&faces, FACES).copied().collect();
    faces.first()?;
    let corners: Vec<DVec3> = polygons.iter().flat_map(|p| &p.corners).copied().collect();
    let corners: Vec<DVec3> = some(&corners, CORNERS).copied().collect();
    let mut planes: Vec<HalfSpace> = faces.iter().map(|p| p.plane).collect();
    if deviation > tolerance {
        planes.extend(across(polygons));
    }
    let cost = |plane: &HalfSpace| {
        let left = |sign: f64| -> f64 {
            let here = |p: &DVec3| sign * plane.height(*p) > tolerance;
            let own: Vec<DVec3> = corners.iter().copied().filter(here).collect();
            let height = |p: &&Polygon| {
                let heights = own.iter().map(|c| p.plane.height(*c));
                heights.fold(0.0, f64::max)
            };
            let mine = faces.iter().filter(|p| p.corners.iter().any(here));
            mine.map(height).sum()
        };
        let divided = polygons
            .iter()
            .filter(|p| p.rises(plane, tolerance) && p.rises(&plane.opposite(), tolerance));
        // Dividing all faces costs a tenth of what all concave ones may rise.
        let price = 0.1 * divided.count() as f64 / polygons.len() as f64;
        left(1.0) + left(-1.0) + price * faces.len() as f64 * deviation
    };
    let costs = planes.iter().map(cost);
    let best = planes.iter().zip(costs);
    let best = best.min_by(|(_, a), (_, b)| a.total_cmp(b))?;
    Some(*best.0)
}

/// Planes across the axes, at quarters of the box around the faces: for round hollows, whose own planes
/// only graze them.
fn across(polygons: &[Polygon]) -> impl Iterator<Item = HalfSpace> {
    let nothing = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let corners = polygons.iter().flat_map(|p| &p.corners);
    let (min, max) = corners.fold(nothing, |(min, max), c| (min.min(*c), max.max(*c)));
    let planes = DVec3::AXES.into_iter().flat_map(move |axis| {
        let at = [0.25, 0.5, 0.75].map(|t| min.lerp(max, t));
        at.map(|point| HalfSpace::through(point, axis))
    });
    planes.filter(move |plane| {
        let thick = plane.normal.dot(max - min);
        thick > 0.0
    })
}

/// At most `count` of `all`, evenly.
pub(super) fn some<T>(all: &[T], count: usize) -> impl Iterator<Item = &T> {
    all.iter().step_by(all.len().div_ceil(count).max(1))
}

/// The faces behind a plane and before it; those on it are sides of the two cells from now on.
pub(super) fn divide(
    polygons: Vec<Polygon>,
    plane: &HalfSpace,
    tolerance: f64,
) -> (Vec<Polygon>, Vec<Polygon>) {
    let (mut behind, mut before) = (Vec::new(), Vec::new());
    for polygon in polygons {
        let front = polygon.rises(plane, tolerance);
        let back = polygon.rises(&plane.opposite(), tolerance);
        match (back, front) {
            (false, false) => {}
            (true, false) => behind.push(polygon),
            (false, true) => before.push(polygon),
            (true, true) => {
                let side = |plane: HalfSpace| Polygon {
                    corners: inside(&polygon.corners, &plane, tolerance),
                    ..polygon
                };
                behind.push(side(*plane));
                before.push(side(plane.opposite()));
            }
        }
    }
    (behind, before)
}

/// The part of a convex polygon inside a half-space.
fn inside(corners: &[DVec3], plane: &HalfSpace, tolerance: f64) -> Vec<DVec3> {
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for (i, a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let (ha, hb) = (plane.height(*a), plane.height(b));
        if ha <= tolerance {
            kept.push(*a);
        }
        if ha.min(hb) < -tolerance && ha.max(hb) > tolerance {
            kept.push(*a + (b - *a) * (ha / (ha - hb)));
        }
    }
    kept
}
