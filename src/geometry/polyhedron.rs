//! A convex polyhedron about its centroid.

use super::HalfSpace;
use super::cell::Cell;
use super::moments::Moments;
use crate::{Error, Result};
use glam::{DMat3, DVec3};

/// Smallest distance of a face from the centroid, as part of the diameter. Contact scales by the
/// diameter and decides to 1e-9 of it, and thinner blocks would have no digits left for their overlap.
pub(super) const SLIVER: f64 = 1e-4;

/// A convex polyhedron, ready for contact: unit normals, no redundant face, coplanar faces merged, the
/// centroid at the origin. Only its constructors make one, so that all of this always holds.
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

    /// The polyhedron that a finished cell is, and the cell's centroid.
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

    /// The polyhedron that a finished cell is, its centroid known.
    pub(super) fn about(cell: Cell, centroid: DVec3) -> Result<Self> {
        let sources: Vec<u32> = cell.facets.iter().map(|f| f.source).collect();
        let block = Self::unchecked(cell, centroid);
        // Also refused if it is not a number.
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

    /// The polyhedron that a compact cell is, however thin.
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

    /// Smallest distance of a face as part of the diameter, twice the radius.
    pub(super) fn thickness(&self) -> f64 {
        self.smallest_distance() / (2.0 * self.radius)
    }
}

impl Cell {
    /// Its moments about `origin`.
    pub(super) fn moments(&self, origin: DVec3) -> Moments {
        let at = |v: u32| self.vertices[v as usize] - origin;
        Moments::of(self.facets.iter().flat_map(|facet| {
            let pairs = facet.ring[1..].windows(2);
            pairs.map(move |pair| [at(facet.ring[0]), at(pair[0]), at(pair[1])])
        }))
    }

    /// The centroid of a compact cell; none if it has no volume.
    pub(super) fn centroid(&self) -> Option<DVec3> {
        let middle = self.vertices.iter().sum::<DVec3>() / self.vertices.len() as f64;
        let moments = self.moments(middle);
        let centroid = middle + moments.centroid();
        (moments.volume > 0.0 && centroid.is_finite()).then_some(centroid)
    }
}
