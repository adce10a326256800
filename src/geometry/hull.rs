//! The convex hull of points, by duality.
//!
//! A point p is inside all planes y · x ≤ 1 of the hull if and only if y is inside the half-space p · y ≤ 1. So the
//! intersection of these half-spaces is the dual of the hull: its faces are the vertices of the hull, and its
//! vertices are the faces of the hull. Clipping a [`Cell`] by the half-spaces drops duplicates and interior points as
//! redundant, and merges coplanar points into one face.

use super::{
    HalfSpace, Polyhedron,
    cell::{Cell, ON},
};
use crate::{Error, Result};
use glam::{DMat3, DVec3};

/// Distance, relative to the size, within which points count as coplanar: far above rounding, far below the accuracy of a
/// scene.
const COPLANAR: f64 = 1e-9;

/// Smallest thickness of a point cloud that is not flat, relative to its size.
const FLAT: f64 = 1e-6;

impl Polyhedron {
    /// The convex hull of points (m), and its centroid (m), which becomes the origin. Duplicates and points inside,
    /// on faces or on edges are dropped, as are points that lie outside by less than about 1e-9 of the size.
    ///
    /// # Errors
    /// If a point is not finite, or all are on one plane, or the hull is a sliver (see
    /// [`Polyhedron::from_half_spaces`]).
    pub fn from_vertices(points: &[DVec3]) -> Result<(Self, DVec3)> {
        Self::hull(points, COPLANAR)
    }

    /// The hull; points count as coplanar within `coplanar`, relative to the size.
    pub(super) fn hull(points: &[DVec3], coplanar: f64) -> Result<(Self, DVec3)> {
        if let Some(bad) = points.iter().position(|p| !p.is_finite()) {
            return Err(Error::argument(
                format!("vertices[{bad}]"),
                format!("{} is not finite; give numbers in m", points[bad]),
            ));
        }
        let corners = simplex(points).ok_or_else(|| {
            let message = "all points lie on one plane, line or point; a block needs a thickness";
            Error::argument("vertices", message)
        })?;
        let centre = corners.iter().sum::<DVec3>() / 4.0;
        let local: Vec<DVec3> = points.iter().map(|p| *p - centre).collect();
        let faces =
            hull_planes(&local, corners.map(|c| c - centre), coplanar).ok_or_else(|| {
                let message =
                    "the points are too near to each other to compute with; check their unit, m";
                Error::argument("vertices", message)
            })?;
        let size = local.iter().map(|p| p.abs().max_element());
        let half = 2.0 * size.fold(0.0, f64::max);
        let mut cell = Cell::cuboid(DVec3::splat(-half), DVec3::splat(half));
        for (index, face) in faces.iter().enumerate() {
            cell.clip(*face, index as u32, ON * half);
        }
        let (polyhedron, centroid) = Self::from_cell(cell)?;
        Ok((polyhedron, centre + centroid))
    }
}

/// Four points that span much of the cloud: an extreme one, then each time the farthest from those before. `None` if all are
/// coplanar.
fn simplex(points: &[DVec3]) -> Option<[DVec3; 4]> {
    let farthest = |height: &dyn Fn(DVec3) -> f64| {
        // The first of equals, so that the result is deterministic.
        let better = |best: DVec3, p: DVec3| if height(p) > height(best) { p } else { best };
        points.iter().copied().reduce(better)
    };
    let a = farthest(&|p| -p.x)?;
    let b = farthest(&|p| p.distance_squared(a))?;
    let size = a.distance(b);
    let along = (b - a).try_normalize()?;
    let c = farthest(&|p| (p - a).cross(along).length_squared())?;
    let up = (c - a).cross(along).try_normalize()?;
    let d = farthest(&|p| (p - a).dot(up).abs())?;
    let thin = (c - a).cross(along).length().min((d - a).dot(up).abs());
    (thin > FLAT * size).then_some([a, b, c, d])
}

/// The planes of the hull. The points are first mapped so that `corners` become a regular tetrahedron: the hull transforms with
/// its points, and the mapped cloud is about as thick as it is long. `None` if the map is not finite.
fn hull_planes(points: &[DVec3], corners: [DVec3; 4], coplanar: f64) -> Option<Vec<HalfSpace>> {
    let regular = DMat3::from_cols(
        DVec3::new(1.0, 1.0, 1.0),
        DVec3::new(1.0, -1.0, -1.0),
        DVec3::new(-1.0, 1.0, -1.0),
    );
    // The mean of the corners is the origin, so three of them define the map.
    let map = regular * DMat3::from_cols(corners[0], corners[1], corners[2]).inverse();
    let all: Vec<DVec3> = corners.iter().chain(points).copied().collect();
    let mapped: Vec<DVec3> = all.iter().map(|p| map * *p).collect();
    let mut order: Vec<usize> = (0..all.len()).collect();
    // Far points first, so that few later ones are outside. The sort is stable: equals keep their order.
    order[4..].sort_by(|a, b| {
        let square = |i: usize| mapped[i].length_squared();
        square(*b).total_cmp(&square(*a))
    });
    // The dual of the tetrahedron has its vertices at √3.
    let mut dual = Cell::cuboid(DVec3::splat(-4.0), DVec3::splat(4.0));
    for i in order {
        let length = mapped[i].length();
        if length > 0.0 {
            let plane = HalfSpace {
                normal: mapped[i] / length,
                distance: 1.0 / length,
            };
            dual.clip(plane, i as u32, coplanar);
        }
    }
    dual.compact();
    let mut corners = vec![Vec::new(); dual.vertices.len()];
    for facet in &dual.facets {
        for vertex in &facet.ring {
            corners[*vertex as usize].push(*all.get(facet.source as usize)?);
        }
    }
    let planes = dual.vertices.iter().zip(corners).map(|(y, corners)| {
        let outwards = map.transpose() * *y;
        let normal = normal_of(corners, outwards);
        let support = points.iter().map(|p| normal.dot(*p));
        let distance = support.fold(f64::NEG_INFINITY, f64::max);
        HalfSpace { normal, distance }
    });
    Some(planes.collect())
}

/// Normal of the face with these corners in any order (Newell's method: exact for three, the mean for more). The dual
/// gives this normal only to its tolerance.
fn normal_of(mut corners: Vec<DVec3>, outwards: DVec3) -> DVec3 {
    let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
    let (u, v) = outwards.normalize().any_orthonormal_pair();
    let angle = |p: &DVec3| (*p - middle).dot(v).atan2((*p - middle).dot(u));
    corners.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    let pairs = corners.iter().zip(corners.iter().cycle().skip(1));
    let twice = pairs
        .map(|(a, b)| (*a - middle).cross(*b - middle))
        .sum::<DVec3>();
    // Corners that nearly coincide leave no area; then the normal of the dual is better.
    let normal = twice.normalize_or(outwards.normalize());
    if normal.dot(outwards) > 0.0 {
        normal
    } else {
        outwards.normalize()
    }
}
