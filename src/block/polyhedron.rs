//! A convex polyhedron about its centroid.

use glam::{DMat3, DVec3};

/// A plane face: the points x of the block have `normal` · x ≤ `distance`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    /// Outward unit normal.
    pub normal: DVec3,
    /// Distance of the plane from the origin, m.
    pub distance: f64,
}

/// A convex polyhedron, ready for contact: unit normals, no redundant face, coplanar faces merged, the
/// centroid at the origin. Only its constructors make one, so that all of this always holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyhedron {
    pub(super) faces: Vec<HalfSpace>,
    pub(super) vertices: Vec<DVec3>,
    pub(super) edges: Vec<[u32; 2]>,
    pub(super) loops: Vec<Vec<u32>>,
    pub(super) volume: f64,
    pub(super) inertia: DMat3,
    pub(super) radius: f64,
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

    /// Pairs of vertices, each once.
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
}
