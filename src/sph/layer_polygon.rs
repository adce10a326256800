//! The polygon of a layer of boundary particles parallel to a face, its edges at internal faces, and rows of points on
//! it.

use super::{particle_lattice::ParticleLattice, solid::Solid};
use crate::geometry::{HalfSpace, min_max};
use glam::DVec3;

/// Cosine between a direction and a normal below which the direction lies in the plane.
const PARALLEL: f64 = 1e-9;

/// Tolerance of the bisection for the inset between two close internal faces, in half spacings.
const INSET_TOLERANCE: f64 = 1e-7;

/// Slope to the layer from which the solid beyond an internal face makes the edge re-entrant. Layers of less steep faces
/// meet at the internal face.
const REENTRANT_SLOPE: f64 = 0.9;

/// A point of a layer.
#[derive(Clone, Copy, Debug)]
pub(super) struct LayerPoint {
    /// Position, m.
    pub at: DVec3,
    /// Normal of the layer.
    pub normal: DVec3,
}

/// Bounds of a layer polygon.
pub(super) struct LayerBounds<'a> {
    /// Half-spaces that bound the layer, other than internal faces.
    pub half_spaces: &'a [HalfSpace],
    /// Internal faces, each with the inset of the layer from it, m: negative if the layer continues beyond it.
    pub insets: &'a [(HalfSpace, f64)],
    /// Tolerance by which internal faces move outwards, m.
    pub slack: f64,
    /// The initial square: its centre, projected onto the plane, and its half-width, m.
    pub square: (DVec3, f64),
}

/// The part of a plane inside half-spaces.
pub(super) struct LayerPolygon {
    plane: HalfSpace,
    corners: Vec<DVec3>,
    /// Edges at internal faces, with a parallel layer of another part of the block one spacing farther out.
    inset_edges: Vec<HalfSpace>,
}

impl LayerPolygon {
    /// The square of half-width `half_width` (m) around the projection of `centre`, clipped by `others`; `None` if
    /// nothing remains.
    pub fn new(
        plane: HalfSpace,
        others: impl Iterator<Item = HalfSpace>,
        centre: DVec3,
        half_width: f64,
    ) -> Option<Self> {
        let u = plane.normal.any_orthonormal_vector();
        let v = plane.normal.cross(u);
        let foot = centre - plane.normal * plane.height(centre);
        let signs = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
        let mut corners = signs
            .map(|(s, t)| foot + (u * s + v * t) * half_width)
            .to_vec();
        for other in others {
            corners = clip(&corners, &other);
            if corners.len() < 3 {
                return None;
            }
        }
        Some(Self {
            plane,
            corners,
            inset_edges: Vec::new(),
        })
    }

    /// The polygon within `bounds`. Where the insets leave nothing between two internal faces, or between one and an
    /// edge, they are reduced until a line remains.
    pub fn inset(plane: HalfSpace, bounds: &LayerBounds<'_>) -> Option<Self> {
        let (centre, half_width) = bounds.square;
        // The intersection of the internal face with the plane moves by the inset.
        let moved = |(face, by): &(HalfSpace, f64), factor: f64| {
            let by = if *by > 0.0 { *by * factor } else { *by };
            let tilt = face.normal.cross(plane.normal).length();
            HalfSpace {
                distance: face.distance - by * tilt + bounds.slack,
                ..*face
            }
        };
        let cut = |factor: f64| {
            let faces = bounds.insets.iter().map(|face| moved(face, factor));
            let others = bounds.half_spaces.iter().copied();
            Self::new(plane, others.chain(faces), centre, half_width)
        };
        let mut factor = 1.0;
        let mut polygon = cut(factor);
        if polygon.is_none() {
            polygon = Some(cut(0.0)?);
            let (mut most, mut least) = (1.0, 0.0);
            while most - least > INSET_TOLERANCE {
                let middle = 0.5 * (least + most);
                match cut(middle) {
                    Some(found) => (polygon, least) = (Some(found), middle),
                    None => most = middle,
                }
            }
            factor = least;
        }
        let mut polygon = polygon?;
        let inset = bounds.insets.iter().filter(|(_, by)| *by > 0.0);
        polygon.inset_edges = inset.map(|face| moved(face, factor)).collect();
        Some(polygon)
    }

    /// Sample points on its edge in the plane of `face`; none if it has no edge there.
    pub fn edge(&self, face: &HalfSpace, slack: f64) -> Vec<DVec3> {
        let next = self.corners.iter().cycle().skip(1);
        let on = |x: &DVec3| face.height(*x).abs() < slack;
        let edges = self.corners.iter().zip(next);
        let edges = edges.filter(|(a, b)| on(a) && on(b) && a.distance(**b) > slack);
        edges
            .flat_map(|(a, b)| [0.02, 0.5, 0.98].map(|fraction| a.lerp(*b, fraction)))
            .collect()
    }

    /// Whether its end at `at` (m) along a direction is an inset edge.
    fn ends_at_inset_edge(&self, lattice: &ParticleLattice, direction: DVec3, at: f64) -> bool {
        let at_end = |c: &&DVec3| (c.dot(direction) - at).abs() < lattice.tolerance();
        let mut corners = self.corners.iter().filter(at_end);
        corners.all(|corner| {
            let mut heights = self.inset_edges.iter().map(|edge| edge.height(*corner));
            heights.any(|height| height.abs() < lattice.tolerance())
        })
    }

    /// Sample points: its middle, and points near its corners and the middles of its edges.
    pub fn samples(&self) -> Vec<DVec3> {
        let middle = self.corners.iter().sum::<DVec3>() / self.corners.len() as f64;
        let ends = self.corners.iter().cycle().skip(1);
        let mut samples = vec![middle];
        for (a, b) in self.corners.iter().zip(ends) {
            samples.extend([a.lerp(middle, 0.02), a.midpoint(*b).lerp(middle, 0.02)]);
        }
        samples
    }

    /// Its extent along a direction, m.
    fn extent(&self, direction: DVec3) -> [f64; 2] {
        min_max(self.corners.iter().map(|c| c.dot(direction)))
    }

    /// Whether it is parallel to an axis and extends beyond the lower and the upper end of the domain along it.
    fn passes_ends(&self, lattice: &ParticleLattice, axis: usize) -> [bool; 2] {
        let [low, high] = self.extent(DVec3::AXES[axis]);
        let along = self.plane.normal[axis].abs() < PARALLEL;
        [
            along && low <= lattice.low[axis] + lattice.tolerance(),
            along && high >= lattice.high[axis] - lattice.tolerance(),
        ]
    }

    /// Whether it is parallel to an axis and spans the domain.
    fn spans(&self, lattice: &ParticleLattice, axis: usize) -> bool {
        self.passes_ends(lattice, axis) == [true; 2]
    }

    /// Points about one spacing apart. Along an axis that the polygon spans they are lattice points, which match the rows
    /// of the fluid and the ends of a period. Between one end of the domain and an edge of the polygon they are
    /// lattice points too, which match those of the wall. Along other directions they are evenly spaced from edge to
    /// edge, both included.
    pub fn points(&self, lattice: &ParticleLattice) -> Vec<LayerPoint> {
        let spanned = (0..3).find(|axis| self.spans(lattice, *axis));
        let along = match spanned {
            Some(axis) => DVec3::AXES[axis],
            None => self.longest_edge(),
        };
        let across = self.plane.normal.cross(along).normalize();
        // A direction along an axis points to its positive end.
        let other = (0..3).find(|axis| across[*axis].abs() > 1.0 - PARALLEL);
        let across = other.map_or(across, |axis| DVec3::AXES[axis]);
        let range = self.extent(across);
        let row_to = |axis: usize, end: f64| {
            if self.ends_at_inset_edge(lattice, across, end) {
                lattice.row_to_inset_edge(axis, range, end)
            } else {
                lattice.row_to(axis, range, end)
            }
        };
        let rows = match other.map(|axis| (axis, self.passes_ends(lattice, axis))) {
            Some((axis, [true, true])) => lattice.row(axis, range),
            Some((axis, [true, false])) => row_to(axis, range[1]),
            Some((axis, [false, true])) => row_to(axis, range[0]),
            _ => lattice.evenly_spaced(range),
        };
        let origin = self.plane.normal * self.plane.distance;
        let mut points = Vec::new();
        for row in rows {
            // A row along an edge moves inside, so that rounding does not remove an end of the edge.
            let inset = (1e-3 * lattice.tolerance()).min(0.5 * (range[1] - range[0]));
            let inside = row.clamp(range[0] + inset, range[1] - inset);
            let Some(range) = self.section(along, across, inside) else {
                continue;
            };
            let row_points = match spanned {
                Some(axis) => lattice.row(axis, range),
                None => lattice.evenly_spaced(range),
            };
            points.extend(row_points.into_iter().map(|at| LayerPoint {
                at: origin + along * at + across * row,
                normal: self.plane.normal,
            }));
        }
        points
    }

    /// Direction of its longest edge.
    fn longest_edge(&self) -> DVec3 {
        let next = self.corners.iter().cycle().skip(1);
        let edges = self.corners.iter().zip(next).map(|(a, b)| *b - *a);
        let longest = edges.max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
        let any = || self.plane.normal.any_orthonormal_vector();
        longest.and_then(DVec3::try_normalize).unwrap_or_else(any)
    }

    /// Interval along `along` (m) in which the line at `row` (m) along `across` is inside.
    fn section(&self, along: DVec3, across: DVec3, row: f64) -> Option<[f64; 2]> {
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        let mut extend = |at: f64| range = [range[0].min(at), range[1].max(at)];
        let next = self.corners.iter().cycle().skip(1);
        for (a, b) in self.corners.iter().zip(next) {
            let (below, above) = (a.dot(across) - row, b.dot(across) - row);
            if below * above > 0.0 {
                continue;
            }
            let (from, to) = (a.dot(along), b.dot(along));
            if below == above {
                extend(from);
                extend(to);
            } else {
                extend(from + (to - from) * (below / (below - above)));
            }
        }
        (range[0] <= range[1]).then_some(range)
    }
}

/// The edge of a layer at an internal face, with another part of the block beyond the face.
pub(super) struct LayerEdge {
    /// Sample points on the edge, m; none if the layer does not reach the internal face.
    pub points: Vec<DVec3>,
    /// Depth of the layer, m.
    pub depth: f64,
}

impl LayerEdge {
    /// Inset (m) of the layer in `plane` from the `internal` face, given `solids`, the other parts of the block.
    ///
    /// ```text
    ///        │ B │                │ B │
    ///        │ . │ ½ Δx above     │ . │
    ///   ─────┼───┼─────      ┌────┼ . ├─────
    ///     .  .  .  .  .      │    │ . .  .  .
    ///          A             │  C │   │  A
    /// ```
    ///
    /// Left, a layer of B continues the layer of A below the internal face: the inset is half a spacing. Right, no face of
    /// C separates the layers of A and B, which both continue into C by the depth of all layers: the inset is negative.
    /// Otherwise the layer ends at the internal face.
    pub fn inset(
        &self,
        plane: &HalfSpace,
        internal: &HalfSpace,
        solids: &[&Solid],
        lattice: &ParticleLattice,
    ) -> f64 {
        let half = 0.5 * lattice.spacing;
        let slack = 1e3 * lattice.tolerance();
        let continues = |x: &DVec3| {
            let behind = *x + internal.normal * half;
            solids
                .iter()
                .any(|solid| solid.continues_layer(internal, behind, slack))
        };
        if self.points.iter().any(continues) {
            return half;
        }
        let along = plane.normal.dot(internal.normal);
        // `out` lies in the plane of the layer and leads out of the part; `up` lies in the internal face, towards the surface.
        let out = (internal.normal - plane.normal * along).normalize_or_zero();
        let up = (plane.normal - internal.normal * along) / (1.0 - along * along).max(1e-9);
        let rises = |x: &DVec3| {
            let x = *x + up * self.depth + (out + plane.normal * REENTRANT_SLOPE) * (10.0 * slack);
            solids.iter().any(|solid| solid.depth(x) > 0.0)
        };
        if !self.points.is_empty() && self.points.iter().all(rises) {
            half - f64::from(lattice.layers) * lattice.spacing
        } else {
            0.0
        }
    }
}

/// The part of a convex polygon inside a half-space.
fn clip(corners: &[DVec3], plane: &HalfSpace) -> Vec<DVec3> {
    let mut kept = Vec::with_capacity(corners.len() + 1);
    let next = corners.iter().cycle().skip(1);
    for (a, b) in corners.iter().zip(next) {
        let (from, to) = (plane.height(*a), plane.height(*b));
        if from <= 0.0 {
            kept.push(*a);
        }
        if from.min(to) < 0.0 && from.max(to) > 0.0 {
            kept.push(*a + (*b - *a) * (from / (from - to)));
        }
    }
    kept
}
