//! Convex parts of a solid: its space is divided by planes of its own faces (a binary space partition,
//! Fuchs, Kedem & Naylor 1980, SIGGRAPH 14:124) until what is in each cell is convex, or nearly so.
//!
//! Cells do not overlap, and so neither do the parts. A part holds all of the solid that is in its cell.

use super::cell::{Cell, Clip, ON};
use super::{HalfSpace, Polyhedron};
use crate::solid::TriangleMesh;
use glam::DVec3;

/// Most parts: a compound of more is slow in contact.
pub(super) const PARTS: usize = 128;

/// Planes tried for each cut.
const TRIED: usize = 40;

/// Thickness of a triangle, in roundings, from which its plane is known well enough to cut by.
const BROAD: f64 = 100.0;

/// A mesh about its centroid.
pub(super) struct Mesh {
    pub vertices: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
    /// Length that is rounding, m.
    pub tolerance: f64,
}

/// A piece of a face of the solid.
#[derive(Clone)]
struct Polygon {
    plane: HalfSpace,
    corners: Vec<DVec3>,
    /// Whether its plane is known well.
    broad: bool,
}

impl Mesh {
    pub fn new(mesh: &TriangleMesh, centroid: DVec3, tolerance: f64) -> Self {
        Self {
            vertices: mesh.vertices.iter().map(|v| *v - centroid).collect(),
            triangles: mesh.triangles.clone(),
            tolerance,
        }
    }

    /// Its triangles, but for those without area.
    fn polygons(&self) -> Vec<Polygon> {
        let polygon = |corners: &[u32; 3]| {
            let corners = corners.map(|c| self.vertices[c as usize]);
            let [a, b, c] = corners;
            let twice = (b - a).cross(c - a);
            let longest = (b - a).length().max((c - b).length()).max((a - c).length());
            Some(Polygon {
                plane: HalfSpace::through((a + b + c) / 3.0, twice.try_normalize()?),
                corners: corners.into(),
                broad: twice.length() > BROAD * self.tolerance * longest,
            })
        };
        self.triangles.iter().filter_map(polygon).collect()
    }
}

/// The parts and their centroids (m), which may stand out from the solid by `deviation` (m); none if it
/// would take too many.
pub(super) fn convex_parts(mesh: &Mesh, deviation: f64) -> Option<Vec<(Polyhedron, DVec3)>> {
    let size = mesh.vertices.iter().map(|v| v.abs().max_element());
    let half = 1.1 * size.fold(0.0, f64::max);
    let cell = Cell::cuboid(DVec3::splat(-half), DVec3::splat(half));
    // Inside is only what a cut finds behind a face.
    let mut open = vec![(cell, mesh.polygons(), false)];
    let mut parts = Vec::new();
    while let Some((mut cell, polygons, inside)) = open.pop() {
        if open.len() + parts.len() > PARTS {
            return None;
        }
        if let Some(plane) = best_cut(&polygons, deviation, mesh.tolerance) {
            let (behind, before) = divide(polygons, &plane, mesh.tolerance);
            // A plane that did not divide the cell would be chosen for ever.
            let (inner, outer) = cell.split(plane, 0, ON * half)?;
            open.push((outer, before, false));
            open.push((inner, behind, true));
        } else if inside || !polygons.is_empty() {
            let left = polygons.iter().all(|p| {
                let heights = polygons.iter().flat_map(|q| &q.corners);
                let support = heights.map(|c| p.plane.normal.dot(*c));
                let plane = HalfSpace {
                    distance: support.fold(p.plane.distance, f64::max),
                    ..p.plane
                };
                cell.clip(plane, 0, ON * half) != Clip::Nothing
            });
            if left {
                parts.extend(part(&mut cell, mesh.tolerance));
            }
        }
    }
    Some(parts)
}

/// The hull of a finished cell, faces being one where the mesh's rounding parts them; none if there is
/// nothing of it but rounding.
fn part(cell: &mut Cell, tolerance: f64) -> Option<(Polyhedron, DVec3)> {
    cell.compact();
    let (min, max) = cell.bounds();
    let coplanar = (tolerance / min.distance(max)).min(1e-3);
    Polyhedron::hull(&cell.vertices, coplanar).ok()
}

/// The plane of a face that has others more than `deviation` before it; none if no face has.
fn best_cut(polygons: &[Polygon], deviation: f64, tolerance: f64) -> Option<HalfSpace> {
    let reaches = |plane: &HalfSpace, p: &Polygon, sign: f64, height: f64| {
        let mut heights = p.corners.iter().map(|c| sign * plane.height(*c));
        heights.any(|h| h > height)
    };
    let cuts = |p: &&Polygon| {
        let before = |other| reaches(&p.plane, other, 1.0, deviation);
        p.broad && polygons.iter().any(before)
    };
    // Some faces here and there, and all only if none of those will do.
    let every = polygons.len().div_ceil(8 * TRIED).max(1);
    let some = polygons.iter().step_by(every).filter(cuts);
    let mut candidates: Vec<&Polygon> = some.collect();
    if candidates.is_empty() {
        candidates = polygons.iter().filter(cuts).collect();
    }
    let every = candidates.len().div_ceil(TRIED).max(1);
    let cost = |candidate: &&Polygon| {
        let [mut divided, mut ahead, mut back] = [0_usize; 3];
        for p in polygons {
            let front = reaches(&candidate.plane, p, 1.0, tolerance);
            let rear = reaches(&candidate.plane, p, -1.0, tolerance);
            divided += usize::from(front && rear);
            ahead += usize::from(front);
            back += usize::from(rear);
        }
        // Few divided faces, and as many on one side as on the other.
        8 * divided + ahead.abs_diff(back)
    };
    let best = candidates.into_iter().step_by(every).min_by_key(cost)?;
    Some(best.plane)
}

/// The faces behind a plane and before it; those on it are sides of the two cells from now on.
fn divide(
    polygons: Vec<Polygon>,
    plane: &HalfSpace,
    tolerance: f64,
) -> (Vec<Polygon>, Vec<Polygon>) {
    let (mut behind, mut before) = (Vec::new(), Vec::new());
    for polygon in polygons {
        let heights: Vec<f64> = polygon.corners.iter().map(|c| plane.height(*c)).collect();
        let front = heights.iter().any(|h| *h > tolerance);
        let back = heights.iter().any(|h| *h < -tolerance);
        match (back, front) {
            (false, false) => {}
            (true, false) => behind.push(polygon),
            (false, true) => before.push(polygon),
            (true, true) => {
                let side = |sign: f64| Polygon {
                    plane: polygon.plane,
                    corners: side(&polygon.corners, &heights, sign, tolerance),
                    broad: polygon.broad,
                };
                behind.push(side(-1.0));
                before.push(side(1.0));
            }
        }
    }
    (behind, before)
}

/// The part of a convex polygon where `sign` times the height is positive.
fn side(corners: &[DVec3], heights: &[f64], sign: f64, tolerance: f64) -> Vec<DVec3> {
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for (i, (a, ha)) in corners.iter().zip(heights).enumerate() {
        let next = (i + 1) % corners.len();
        let (b, hb) = (corners[next], heights[next]);
        if sign * ha >= -tolerance {
            kept.push(*a);
        }
        if (*ha > tolerance && hb < -tolerance) || (*ha < -tolerance && hb > tolerance) {
            kept.push(*a + (b - *a) * (ha / (ha - hb)));
        }
    }
    kept
}
