//! A convex polyhedron about its centroid, from its faces; boxes and the regular solids.

use super::cell::{Cell, Clip, ON, START};
use crate::{Error, Result};
use glam::{DMat3, DVec3};
use std::f64::consts::SQRT_2;

/// Smallest distance of a face from the centroid, relative to the diameter. Contact scales lengths by the diameter
/// and resolves 1e-9 of it; thinner blocks would leave no significant digits for the overlap.
pub(super) const SLIVER: f64 = 1e-4;

/// A convex polyhedron, ready for contact: unit normals, no redundant face, coplanar faces merged, the centroid at
/// the origin. Its constructors guarantee all of this.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyhedron {
    faces: Vec<HalfSpace>,
    vertices: Vec<DVec3>,
    edges: Vec<[u32; 2]>,
    loops: Vec<Vec<u32>>,
    volume: f64,
    inertia: DMat3,
    radius: f64,
}

impl Polyhedron {
    /// Faces, about the centroid.
    pub fn faces(&self) -> &[HalfSpace] {
        &self.faces
    }

    /// Vertices from the centroid, m.
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// Edges as pairs of vertices, each edge once.
    pub fn edges(&self) -> &[[u32; 2]] {
        &self.edges
    }

    /// The vertices around each face, counter-clockwise seen from outside.
    pub fn loops(&self) -> &[Vec<u32>] {
        &self.loops
    }

    /// Volume, m³.
    pub fn volume(&self) -> f64 {
        self.volume
    }

    /// Inertia tensor about the centroid for a density of one, m⁵.
    pub fn inertia(&self) -> DMat3 {
        self.inertia
    }

    /// Largest distance of a vertex from the centroid, m.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Smallest distance of a face from the centroid, m.
    pub fn smallest_distance(&self) -> f64 {
        let distances = self.faces.iter().map(|f| f.distance);
        distances.fold(f64::INFINITY, f64::min)
    }

    /// The polyhedron of a finished cell, and the cell's centroid.
    pub(super) fn from_cell(mut cell: Cell) -> Result<(Self, DVec3)> {
        cell.compact();
        cell.settle();
        let Some(centroid) = cell.centroid() else {
            return Err(Error::argument(
                "faces",
                "they enclose no volume; check the signs and the unit of the distances",
            ));
        };
        Ok((Self::about(cell, centroid)?, centroid))
    }

    /// The polyhedron of a finished cell with a known centroid.
    pub(super) fn about(cell: Cell, centroid: DVec3) -> Result<Self> {
        let sources: Vec<u32> = cell.facets.iter().map(|f| f.source).collect();
        let block = Self::unchecked(cell, centroid);
        // Also refuses NaN.
        let thick = |f: &HalfSpace| f.distance >= SLIVER * 2.0 * block.radius;
        match block.faces.iter().position(|f| !thick(f)) {
            None => Ok(block),
            Some(thin) => Err(Error::argument(
                format!("faces[{}]", sources[thin]),
                format!(
                    "its face is {:.3e} m from the centroid of a block {:.3e} m across: thinner \
                     than 1/10000, contact cannot resolve it; make the block thicker or leave it out",
                    block.faces[thin].distance,
                    2.0 * block.radius
                ),
            )),
        }
    }

    /// The polyhedron of a compact cell, however thin.
    pub(super) fn unchecked(cell: Cell, centroid: DVec3) -> Self {
        let moments = cell.moments(centroid);
        let vertices: Vec<DVec3> = cell.vertices.iter().map(|v| *v - centroid).collect();
        let square = vertices.iter().map(|v| v.length_squared());
        let radius = square.fold(0.0, f64::max).sqrt();
        let mut faces = Vec::with_capacity(cell.facets.len());
        let mut loops = Vec::with_capacity(cell.facets.len());
        let mut edges = Vec::with_capacity(cell.vertices.len() + cell.facets.len());
        for facet in cell.facets {
            let ring = &facet.ring;
            let pairs = ring.iter().zip(ring.iter().cycle().skip(1));
            edges.extend(pairs.filter(|(a, b)| a < b).map(|(a, b)| [*a, *b]));
            faces.push(facet.plane.seen_from(centroid));
            loops.push(facet.ring);
        }
        Self {
            faces,
            vertices,
            edges,
            loops,
            volume: moments.volume,
            inertia: moments.inertia(),
            radius,
        }
    }

    /// Smallest distance of a face from the centroid, relative to the diameter, twice the radius.
    pub(super) fn thickness(&self) -> f64 {
        self.smallest_distance() / (2.0 * self.radius)
    }

    /// The points inside all of `faces`, and their centroid (m), which becomes the origin. Redundant faces are
    /// dropped, coplanar ones are merged, and the others keep their order. Normals need not have unit length: both
    /// sides of n · x ≤ d are divided by |n|.
    ///
    /// # Errors
    /// If a face is not finite or has no normal, or if the intersection is unbounded, empty, or a sliver (a face
    /// nearer to the centroid than 1e-4 of the diameter, twice the radius). Names the face.
    pub fn from_half_spaces(faces: &[HalfSpace]) -> Result<(Self, DVec3)> {
        Self::from_cell(cell_of(&unit(faces)?)?)
    }

    /// The box with these edges (m) along its axes.
    ///
    /// # Errors
    /// If an edge is not positive, or the box is a sliver.
    pub fn cuboid(edges: DVec3) -> Result<Self> {
        for (axis, edge) in edges.to_array().into_iter().enumerate() {
            positive(&format!("edges[{axis}]"), edge)?;
        }
        let mut cell = Cell::cuboid(-edges / 2.0, edges / 2.0);
        for (index, facet) in cell.facets.iter_mut().enumerate() {
            facet.source = index as u32;
        }
        Self::about(cell, DVec3::ZERO)
    }

    /// The regular tetrahedron with this edge (m), corners along (1, 1, 1), (1, −1, −1) and so on.
    ///
    /// # Errors
    /// If the edge is not positive.
    pub fn tetrahedron(edge: f64) -> Result<Self> {
        let corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]];
        let corners = corners.map(|c| DVec3::from(c.map(f64::from)));
        regular(edge, 2.0 * SQRT_2, corners.into())
    }

    /// The regular octahedron with this edge (m), corners on the axes.
    ///
    /// # Errors
    /// If the edge is not positive.
    pub fn octahedron(edge: f64) -> Result<Self> {
        let axes = [DVec3::X, DVec3::Y, DVec3::Z];
        let corners = axes.into_iter().flat_map(|a| [a, -a]);
        regular(edge, SQRT_2, corners.collect())
    }

    /// The regular dodecahedron with this edge (m), eight of its corners along (±1, ±1, ±1).
    ///
    /// # Errors
    /// If the edge is not positive.
    pub fn dodecahedron(edge: f64) -> Result<Self> {
        let sign = |i: u32, bit: u32| if i >> bit & 1 == 0 { 1.0 } else { -1.0 };
        let cube = (0..8).map(|i| DVec3::new(sign(i, 0), sign(i, 1), sign(i, 2)));
        let corners = cube.chain(rectangles(1.0 / PHI, PHI));
        regular(edge, 2.0 / PHI, corners.collect())
    }

    /// The regular icosahedron with this edge (m), its corners on three golden rectangles.
    ///
    /// # Errors
    /// If the edge is not positive.
    pub fn icosahedron(edge: f64) -> Result<Self> {
        regular(edge, 2.0, rectangles(1.0, PHI).collect())
    }
}

/// A plane face: the points x of the block have `normal` · x ≤ `distance`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    /// Outward unit normal.
    pub normal: DVec3,
    /// Distance of the plane from the origin, m.
    pub distance: f64,
}

impl HalfSpace {
    /// The half-space with the outward `normal` (of any length) whose plane passes through `point` (m).
    pub fn through(point: DVec3, normal: DVec3) -> Self {
        let normal = normal.normalize_or_zero();
        Self {
            normal,
            distance: normal.dot(point),
        }
    }

    /// How far `point` is outside, m; negative inside.
    pub fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point) - self.distance
    }

    /// The other side of the same plane, with exactly opposite numbers.
    pub fn opposite(&self) -> Self {
        Self {
            normal: -self.normal,
            distance: -self.distance,
        }
    }

    /// The same half-space with coordinates from `origin` (m).
    pub fn seen_from(&self, origin: DVec3) -> Self {
        Self {
            normal: self.normal,
            distance: self.distance - self.normal.dot(origin),
        }
    }
}

/// Half-width of the box about the unit sphere beyond which the polyhedron of the sphere's tangent planes counts as
/// unbounded: a block as long as this would be a sliver by far.
const FAR: f64 = 1e6;

/// The faces with unit normals.
pub(super) fn unit(faces: &[HalfSpace]) -> Result<Vec<HalfSpace>> {
    let scaled = faces.iter().enumerate().map(|(index, face)| {
        let length = face.normal.length();
        let distance = face.distance / length;
        if !(length > 0.0 && length.is_finite() && distance.is_finite()) {
            let (n, d) = (face.normal, face.distance);
            return Err(Error::argument(
                format!("faces[{index}]"),
                format!("normal {n} and distance {d} m are no plane; give finite numbers and a normal that is not zero"),
            ));
        }
        // A unit normal stays bitwise the same.
        if (length - 1.0).abs() <= 2.0 * f64::EPSILON {
            return Ok(*face);
        }
        Ok(HalfSpace {
            normal: face.normal / length,
            distance,
        })
    });
    scaled.collect()
}

/// The cell that `faces` (unit normals) bound. Facets store the index of their face and exactly its plane.
pub(super) fn cell_of(faces: &[HalfSpace]) -> Result<Cell> {
    let reach = reach(faces)?;
    let largest = faces.iter().map(|f| f.distance.abs()).fold(0.0, f64::max);
    // n · x ≤ d ≤ largest: all points lie in the scaled polyhedron of the tangent planes.
    let (mut centre, mut half) = (DVec3::ZERO, 1.01 * reach * largest);
    loop {
        let mut cell = clip_box(faces, centre, half)?;
        let [min, max] = cell.bounds();
        let size = (max - min).max_element() / 2.0;
        // Repeat from a box of its size; otherwise the rounding of the large box would remain.
        if size < half / 8.0 {
            (centre, half) = ((min + max) / 2.0, 2.0 * size);
            continue;
        }
        cell.vertices.iter_mut().for_each(|v| *v += centre);
        for facet in &mut cell.facets {
            facet.plane = faces[facet.source as usize];
        }
        return Ok(cell);
    }
}

/// The box of half-width `half` about `centre`, clipped by `faces`, with coordinates from `centre`.
fn clip_box(faces: &[HalfSpace], centre: DVec3, half: f64) -> Result<Cell> {
    let mut cell = Cell::cuboid(DVec3::splat(-half), DVec3::splat(half));
    for (index, face) in faces.iter().enumerate() {
        if cell.clip(face.seen_from(centre), index as u32, ON * half) == Clip::Nothing {
            return Err(Error::argument(
                format!("faces[{index}]"),
                "nothing is left inside it of what the faces before it bound; check the signs of its \
                 normal (outwards) and its distance",
            ));
        }
    }
    if cell.facets.iter().any(|f| f.source == START) {
        return Err(Error::argument(
            "faces",
            "they meet in a point and enclose no volume; check the distances",
        ));
    }
    Ok(cell)
}

/// Largest distance from the origin in the polyhedron of all tangent planes n · x ≤ 1. This polyhedron is bounded if
/// and only if every nonempty polyhedron with these normals is bounded.
fn reach(faces: &[HalfSpace]) -> Result<f64> {
    let mut cell = Cell::cuboid(DVec3::splat(-FAR), DVec3::splat(FAR));
    for face in faces {
        let tangent = HalfSpace {
            normal: face.normal,
            distance: 1.0,
        };
        cell.clip(tangent, 0, ON * FAR);
    }
    let longest = |a: DVec3, b: DVec3| if b.length() > a.length() { b } else { a };
    let far = cell.live().fold(DVec3::ZERO, longest);
    if cell.facets.iter().any(|f| f.source == START) {
        let d = far.normalize();
        return Err(Error::argument(
            "faces",
            format!(
                "{} faces leave the block unbounded towards ({:.3}, {:.3}, {:.3}); add a face there",
                faces.len(),
                d.x,
                d.y,
                d.z
            ),
        ));
    }
    Ok(far.length())
}

/// The golden ratio.
const PHI: f64 = 1.618_033_988_749_895;

/// The corners (0, ±a, ±b) and their cyclic permutations.
fn rectangles(a: f64, b: f64) -> impl Iterator<Item = DVec3> {
    let corners = [[a, b], [a, -b], [-a, b], [-a, -b]].into_iter();
    corners.flat_map(|[a, b]| {
        let turned = [[0.0, a, b], [b, 0.0, a], [a, b, 0.0]];
        turned.map(DVec3::from)
    })
}

/// The hull of `corners`, scaled from `unit` to `edge`.
fn regular(edge: f64, unit: f64, corners: Vec<DVec3>) -> Result<Polyhedron> {
    positive("edge", edge)?;
    let scaled: Vec<DVec3> = corners.iter().map(|c| *c * (edge / unit)).collect();
    Ok(Polyhedron::from_vertices(&scaled)?.0)
}

/// Refuses a length (m) that is not positive.
pub(super) fn positive(place: &str, length: f64) -> Result<()> {
    if length > 0.0 && length.is_finite() {
        return Ok(());
    }
    Err(Error::argument(
        place,
        format!("{length} m is no length; give a positive number in m"),
    ))
}
