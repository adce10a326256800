//! Convex parts of a solid: space is divided (a binary space partition, Fuchs, Kedem & Naylor 1980, SIGGRAPH 14:124)
//! until the solid in each cell is convex, or nearly so.
//!
//! Cells do not overlap, and neither do the parts. A part contains all of the solid in its cell.

use super::{
    Form, HalfSpace, Part, Polyhedron, Shape, bounding_box,
    cell::{Cell, Clip, Moments, ON},
    polyhedron::positive,
};
use crate::{
    Error, Result,
    geometry::{TriangleMesh, WindingTree},
};
use glam::DVec3;
use std::path::Path;

/// Largest number of parts: contact is slow for compounds of more parts.
const PARTS: usize = 64;

/// Number of faces tested for concavity before the hull of a mesh is computed.
const SAMPLE: usize = 200;

/// A mesh about its centroid.
pub(super) struct Mesh {
    pub triangles: TriangleMesh,
    winding: WindingTree,
    /// Lengths below this are rounding, m.
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

    /// Whether a sample of the faces shows that the mesh is concave by more than rounding.
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

    /// Whether a cell that no face crosses is inside the mesh.
    fn holds(&self, cell: &mut Cell) -> bool {
        cell.compact();
        cell.centroid().is_some_and(|c| self.winding.at(c) > 0.5)
    }
}

/// Convex parts of a mesh and their centroids (m). The parts may protrude from the solid by `deviation` (m); `None`
/// if more than [`PARTS`] would be needed.
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
        // A plane that does not divide the cell would be chosen again and again.
        let (inner, outer) = cell.split(plane, 0, on)?;
        open.push((outer, before));
        open.push((inner, behind));
    }
    Some(parts)
}

/// Clips a cell by the planes of its faces, each moved out so that all faces are behind it; `None` if nothing
/// remains. The error is the plane of a face with solid in front of it and beyond all faces, that is, of a dent.
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

/// The hull of a finished cell. Faces that differ only by the rounding of the mesh are merged; `None` if the cell is
/// flat up to rounding.
fn part(mut cell: Cell, tolerance: f64) -> Option<(Polyhedron, DVec3)> {
    cell.compact();
    let [min, max] = cell.bounds();
    let coplanar = (tolerance / min.distance(max)).min(1e-3);
    Polyhedron::hull(&cell.vertices, coplanar).ok()
}

/// Rounding of coordinates relative to the size of a mesh: STL files and many programs store f32 (6e-8).
pub(super) const ROUNDING: f64 = 1e-6;

/// Volume over the cube of the size below which a mesh is flat: above that of a block of 1 × 3e-5 × 3e-5.
const FLAT: f64 = 1e-9;

/// Relative difference of volumes that [`ROUNDING`] explains: six faces of a box, with a margin.
const SAME: f64 = 1e-5;

/// Distances by which convex parts may protrude from a mesh, relative to its size, tried from the left: exact parts
/// for few concave edges, approximate ones for many.
const DEVIATIONS: [f64; 7] = [ROUNDING, 0.002, 0.005, 0.01, 0.02, 0.03, 0.05];

/// Largest relative difference between the volume of a mesh and that of its convex parts.
const UNLIKE: f64 = 0.05;

impl Shape {
    /// Reads a closed mesh from an STL or OBJ file whose unit is `scale` (m). See [`Shape::from_mesh`].
    ///
    /// # Errors
    /// If the scale is not positive, the file cannot be read, or the mesh is not valid as a block.
    pub fn read(path: &Path, scale: f64) -> Result<(Self, DVec3)> {
        positive("scale", scale)?;
        let mesh = TriangleMesh::read(path, scale, [0.0; 3])?;
        Self::from_mesh(&mesh).map_err(|e| match e {
            Error::Argument { message, .. } => Error::file(path, message),
            other => other,
        })
    }

    /// The solid that a closed mesh encloses, and its centroid (m), which becomes the origin. A convex mesh becomes
    /// one polyhedron; faces within 1e-6 of the size of one plane are merged. Any other mesh becomes a compound of at
    /// most 64 convex parts that do not overlap. The parts are exact if the mesh has few concave edges. Otherwise
    /// they contain the mesh and protrude from it by at most 5 % of its size and 5 % of its volume, or by less if 64
    /// parts suffice. Volume, centroid and inertia are exactly those of the mesh, whatever the parts. A mesh of 10⁴
    /// triangles takes seconds, one of 4·10⁴ a minute.
    ///
    /// # Errors
    /// If the mesh is open, inverted, flat or crosses itself, or if convex parts do not approximate it well enough.
    pub fn from_mesh(mesh: &TriangleMesh) -> Result<(Self, DVec3)> {
        let refuse = |message: String| Error::argument("mesh", message);
        let count = mesh.vertices.len();
        let whole = |corners: &[u32; 3]| corners.iter().all(|c| (*c as usize) < count);
        if !mesh.vertices.iter().all(|v| v.is_finite()) || !mesh.triangles.iter().all(whole) {
            let message = "a vertex is not finite or not there; export the mesh again";
            return Err(refuse(message.into()));
        }
        mesh.closed().map_err(refuse)?;
        let (min, max) = mesh.bounds();
        let (min, max) = (DVec3::from(min), DVec3::from(max));
        let size = min.distance(max);
        let moments = |origin: DVec3| {
            let triangles = 0..mesh.triangles.len();
            Moments::of(triangles.map(|t| mesh.corners(t).map(|c| c - origin)))
        };
        let middle = (min + max) / 2.0;
        let first = moments(middle);
        let volume = first.volume;
        // Also false without triangles, when the size is not finite.
        let thick = volume.abs() > FLAT * size.powi(3);
        if !thick {
            return Err(refuse(format!(
                "the mesh is flat: {volume:.3e} m³ in a box {size:.3e} m across; a block needs a thickness"
            )));
        }
        if volume < 0.0 {
            return Err(refuse(format!(
                "the mesh is inside out (volume {volume:.6e} m³); turn its triangles, counter-clockwise \
                 seen from outside"
            )));
        }
        let centroid = middle + first.centroid();
        let local = Mesh::new(mesh, centroid, ROUNDING * size);
        if !local.hollow() {
            let (hull, shift) = Polyhedron::hull(&local.triangles.vertices, ROUNDING)?;
            if (hull.volume() - volume).abs() <= SAME * volume {
                return Ok((hull.into(), centroid + shift));
            }
        }
        let about = moments(centroid);
        let inertia = about.inertia();
        let [a, b, c] = [inertia.x_axis.x, inertia.y_axis.y, inertia.z_axis.z];
        if !(a > 0.0 && b > 0.0 && c > 0.0 && inertia.determinant() > 0.0) {
            let message = "the mesh crosses itself (its inertia is not positive); repair it";
            return Err(refuse(message.into()));
        }
        let unlike = |parts: &[(Polyhedron, DVec3)]| {
            let sum: f64 = parts.iter().map(|(p, _)| p.volume()).sum();
            (sum - volume) / volume
        };
        let tried = DEVIATIONS.iter().filter_map(|deviation| {
            let parts = convex_parts(&local, deviation * size)?;
            let limit = if *deviation == ROUNDING { SAME } else { UNLIKE };
            (unlike(&parts).abs() <= limit).then_some(parts)
        });
        let Some(parts) = tried.into_iter().next() else {
            return Err(refuse(format!(
                "no compound of at most {PARTS} convex parts comes within {} % of the mesh's volume of \
                 {volume:.6e} m³; simplify or repair it, or give its convex parts",
                100.0 * UNLIKE
            )));
        };
        let parts = parts.into_iter().map(|(polyhedron, offset)| Part {
            form: Form::Convex(polyhedron),
            offset,
        });
        Ok((
            Self::of(parts.collect(), DVec3::ZERO, volume, inertia),
            centroid,
        ))
    }
}

/// Number of faces whose planes are tried as cuts and by which cuts are rated.
const FACES: usize = 48;

/// Number of corners by which cuts are rated.
const CORNERS: usize = 192;

/// Height of a triangle, in units of the tolerance, from which its plane is accurate enough for a cut.
const BROAD: f64 = 100.0;

/// A piece of a face.
#[derive(Clone)]
pub(super) struct Polygon {
    pub plane: HalfSpace,
    pub corners: Vec<DVec3>,
    /// Whether its plane is accurate enough for a cut.
    pub broad: bool,
}

impl Polygon {
    /// The triangles of a mesh, without those that have no area.
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

/// The best plane to divide a cell that is not convex: the candidate with the least sum of heights of corners above
/// faces on the same side. `None` if no face has corners more than `deviation` (m) above it.
fn best_cut(polygons: &[Polygon], deviation: f64, tolerance: f64) -> Option<HalfSpace> {
    let concave = |p: &&Polygon| p.broad && polygons.iter().any(|o| o.rises(&p.plane, deviation));
    // First a sample of the faces; all of them only if the sample has no concave face.
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
        // Dividing all faces costs a tenth of `deviation` for each concave face.
        let price = 0.1 * divided.count() as f64 / polygons.len() as f64;
        left(1.0) + left(-1.0) + price * faces.len() as f64 * deviation
    };
    let costs = planes.iter().map(cost);
    let best = planes.iter().zip(costs);
    let best = best.min_by(|(_, a), (_, b)| a.total_cmp(b))?;
    Some(*best.0)
}

/// Planes normal to the axes, at quarters of the bounding box of the faces: for round hollows, which the planes of
/// their own faces only graze.
fn across(polygons: &[Polygon]) -> impl Iterator<Item = HalfSpace> {
    let [min, max] = bounding_box(polygons.iter().flat_map(|p| &p.corners).copied());
    let planes = DVec3::AXES.into_iter().flat_map(move |axis| {
        let at = [0.25, 0.5, 0.75].map(|t| min.lerp(max, t));
        at.map(|point| HalfSpace::through(point, axis))
    });
    planes.filter(move |plane| {
        let thick = plane.normal.dot(max - min);
        thick > 0.0
    })
}

/// At most `count` of `all`, evenly spaced.
pub(super) fn some<T>(all: &[T], count: usize) -> impl Iterator<Item = &T> {
    all.iter().step_by(all.len().div_ceil(count).max(1))
}

/// The faces behind a plane and in front of it, without those on it, which now bound the two cells.
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
