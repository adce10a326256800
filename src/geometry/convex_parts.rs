//! Convex parts of a solid: its space is divided (a binary space partition, Fuchs, Kedem & Naylor 1980,
//! SIGGRAPH 14:124) until what is in each cell is convex, or nearly so.
//!
//! Cells do not overlap, and so neither do the parts. A part holds all of the solid that is in its cell.

use super::cell::{Cell, Clip, ON};
use super::polygons::{Polygon, best_cut, divide, some};
use super::{HalfSpace, Polyhedron};
use crate::geometry::{TriangleMesh, WindingTree};
use glam::DVec3;

/// Most parts: a compound of more is slow in contact.
pub(super) const PARTS: usize = 64;

/// Faces that are tested for concavity of a mesh, before its hull is made to find out.
const SAMPLE: usize = 200;

/// A mesh about its centroid.
pub(super) struct Mesh {
    pub triangles: TriangleMesh,
    winding: WindingTree,
    /// Length that is rounding, m.
    tolerance: f64,
}

impl Mesh {
    pub fn new(mesh: &TriangleMesh, centroid: DVec3, tolerance: f64) -> Self {
        let triangles = TriangleMesh {
            vertices: mesh.vertices.iter().map(|v| *v - centroid).collect(),
            triangles: mesh.triangles.clone(),
        };
        Self {
            winding: WindingTree::new(&triangles),
            triangles,
            tolerance,
        }
    }

    /// Whether some of its faces show it to be concave, by more than rounding.
    pub fn hollow(&self) -> bool {
        let polygons = Polygon::all(&self.triangles, self.tolerance);
        let faces = some(&polygons, SAMPLE).filter(|p| p.broad);
        let over = |p: &Polygon| {
            polygons
                .iter()
                .any(|o| o.rises(&p.plane, 10.0 * self.tolerance))
        };
        faces.into_iter().any(over)
    }

    /// Whether a cell that no face crosses is inside.
    fn holds(&self, cell: &mut Cell) -> bool {
        cell.compact();
        cell.centroid().is_some_and(|c| self.winding.at(c) > 0.5)
    }
}

/// The parts and their centroids (m), which may stand out from the solid by `deviation` (m); none if it
/// would take too many.
pub(super) fn convex_parts(mesh: &Mesh, deviation: f64) -> Option<Vec<(Polyhedron, DVec3)>> {
    let size = mesh
        .triangles
        .vertices
        .iter()
        .map(|v| v.abs().max_element());
    let half = 1.1 * size.fold(0.0, f64::max);
    let on = ON * half;
    let cell = Cell::cuboid(DVec3::splat(-half), DVec3::splat(half));
    let mut open = vec![(cell, Polygon::all(&mesh.triangles, mesh.tolerance))];
    let mut parts = Vec::new();
    while let Some((mut cell, polygons)) = open.pop() {
        if open.len() + parts.len() > PARTS {
            return None;
        }
        if polygons.is_empty() {
            if mesh.holds(&mut cell) {
                parts.extend(part(cell, mesh.tolerance));
            }
            continue;
        }
        let cut = best_cut(&polygons, deviation, mesh.tolerance);
        let plane = match cut.map_or_else(|| convex(mesh, &cell, &polygons, on), Err) {
            Ok(convex) => {
                parts.extend(convex.and_then(|cell| part(cell, mesh.tolerance)));
                continue;
            }
            Err(plane) => plane,
        };
        let (behind, before) = divide(polygons, &plane, mesh.tolerance);
        // A plane that did not divide the cell would be chosen for ever.
        let (inner, outer) = cell.split(plane, 0, on)?;
        open.push((outer, before));
        open.push((inner, behind));
    }
    Some(parts)
}

/// What the planes of the faces leave of a cell, moved out so that all faces are behind all planes; none
/// if that is nothing. Or the plane of a face that has solid before it, beyond all faces: of a dent.
fn convex(
    mesh: &Mesh,
    cell: &Cell,
    polygons: &[Polygon],
    on: f64,
) -> Result<Option<Cell>, HalfSpace> {
    let mut left = cell.clone();
    for polygon in polygons {
        let corners = polygons.iter().flat_map(|p| &p.corners);
        let support = corners.map(|c| polygon.plane.normal.dot(*c));
        let plane = HalfSpace {
            distance: support.fold(polygon.plane.distance, f64::max),
            ..polygon.plane
        };
        let mut beyond = left.clone();
        match left.clip(plane, 0, on) {
            Clip::All => continue,
            Clip::Nothing => return Ok(None),
            Clip::Part => beyond.clip(plane.opposite(), 0, on),
        };
        if mesh.holds(&mut beyond) {
            return Err(polygon.plane);
        }
    }
    Ok(Some(left))
}

/// The hull of a finished cell, faces being one where the mesh's rounding parts them; none if there is
/// nothing of it but rounding.
fn part(mut cell: Cell, tolerance: f64) -> Option<(Polyhedron, DVec3)> {
    cell.compact();
    let (min, max) = cell.bounds();
    let coplanar = (tolerance / min.distance(max)).min(1e-3);
    Polyhedron::hull(&cell.vertices, coplanar).ok()
}
