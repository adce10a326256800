//! Convex parts of a solid: its space is divided (a binary space partition, Fuchs, Kedem & Naylor 1980,
//! SIGGRAPH 14:124) until what is in each cell is convex, or nearly so.
//!
//! Cells do not overlap, and so neither do the parts. A part holds all of the solid that is in its cell.

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

/// Most parts: a compound of more is slow in contact.
const PARTS: usize = 64;

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
    let [min, max] = cell.bounds();
    let coplanar = (tolerance / min.distance(max)).min(1e-3);
    Polyhedron::hull(&cell.vertices, coplanar).ok()
}

/// Part of a mesh's size that is rounding: STL files and many programs know coordinates to f32 (6e-8).
pub(super) const ROUNDING: f64 = 1e-6;

/// Volume of a mesh that is flat, as part of its size cubed: less than a block of 1 × 3e-5 × 3e-5.
const FLAT: f64 = 1e-9;

/// Relative difference of volumes that [`ROUNDING`] explains: six faces of a box, and some.
const SAME: f64 = 1e-5;

/// By how much convex parts may stand out from a mesh, as part of its size, tried from the left: exact
/// parts where there are few concave edges, near ones where there are many.
const DEVIATIONS: [f64; 7] = [ROUNDING, 0.002, 0.005, 0.01, 0.02, 0.03, 0.05];

/// Most by which the volume of a mesh and the sum of its convex parts may differ.
const UNLIKE: f64 = 0.05;

impl Shape {
    /// Reads a closed mesh from an STL or OBJ file; its unit becomes `scale` m. See [`Shape::from_mesh`].
    ///
    /// # Errors
    /// If the scale is not positive, the file cannot be read, or the mesh is no block.
    pub fn read(path: &Path, scale: f64) -> Result<(Self, DVec3)> {
        positive("scale", scale)?;
        let mesh = TriangleMesh::read(path, scale, [0.0; 3])?;
        Self::from_mesh(&mesh).map_err(|e| match e {
            Error::Argument { message, .. } => Error::file(path, message),
            other => other,
        })
    }

    /// The solid that a closed mesh encloses, and its centroid (m), which becomes the origin. A convex
    /// mesh becomes one polyhedron, faces within 1e-6 of the size on one plane being one. Any other
    /// becomes a compound of at most 64 convex parts that do not overlap: exact ones if it has few concave
    /// edges, else parts that hold all of it and stand out from it by at most 5 % of its size and 5 % of
    /// its volume, by less where 64 suffice for less. Volume, centroid and inertia are those of the mesh
    /// itself, exact, whatever the parts. A mesh of 10⁴ triangles takes seconds, one of 4·10⁴ a minute.
    ///
    /// # Errors
    /// If the mesh is open, inverted, flat, or no solid, or convex parts do not come near enough to it.
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
        // Not true either if there is no triangle, and the size is not a number.
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
fn best_cut(polygons: &[Polygon], deviation: f64, tolerance: f64) -> Option<HalfSpace> {
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
