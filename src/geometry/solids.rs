//! Boxes and the regular solids.

use super::Polyhedron;
use super::cell::Cell;
use crate::{Error, Result};
use glam::DVec3;
use std::f64::consts::SQRT_2;

/// The golden ratio.
const PHI: f64 = 1.618_033_988_749_895;

impl Polyhedron {
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
