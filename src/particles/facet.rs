//! The plane polygon that is left of a facet some way below it, and rows of points on it.

use super::{gaps::Laid, lattice::Lattice};
use crate::block::HalfSpace;
use glam::DVec3;

/// Cosine of the angle to a plane below which a direction lies in it.
const WITHIN: f64 = 1e-9;

/// How precisely the place between two seams that are near each other is found, of half a spacing.
const PRECISE: f64 = 1e-7;

/// The part of a plane that lies in all of some half-spaces.
pub(super) struct Facet {
    plane: HalfSpace,
    corners: Vec<DVec3>,
    /// Edges a layer of another part of the block is parallel to, a spacing farther out.
    laid: Vec<HalfSpace>,
}

impl Facet {
    /// What the square of half-width `reach` (m) about the foot of `about` has in common with `others`; none
    /// if that is nothing.
    pub fn new(
        plane: HalfSpace,
        others: impl Iterator<Item = HalfSpace>,
        about: DVec3,
        reach: f64,
    ) -> Option<Self> {
        let u = plane.normal.any_orthonormal_vector();
        let v = plane.normal.cross(u);
        let foot = about - plane.normal * plane.height(about);
        let signs = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
        let mut corners = signs.map(|(s, t)| foot + (u * s + v * t) * reach).to_vec();
        for other in others {
            corners = clip(&corners, &other);
            if corners.len() < 3 {
                return None;
            }
        }
        Some(Self {
            plane,
            corners,
            laid: Vec::new(),
        })
    }

    /// The same, and it ends before each of `seams` by a length (m), or beyond it by one below 0. Where seams, or one
    /// and an edge, are too near each other for that, what is left between them is a line.
    pub fn beside(
        plane: HalfSpace,
        others: &[HalfSpace],
        (seams, slack): (&[(HalfSpace, f64)], f64),
        (about, reach): (DVec3, f64),
    ) -> Option<Self> {
        // So that the trace of the seam in the plane moves by that length.
        let moved = |(seam, by): &(HalfSpace, f64), share: f64| {
            let by = if *by > 0.0 { *by * share } else { *by };
            HalfSpace {
                distance: seam.distance - by * seam.normal.cross(plane.normal).length() + slack,
                ..*seam
            }
        };
        let cut = |share: f64| {
            let seams = seams.iter().map(|seam| moved(seam, share));
            Self::new(plane, others.iter().copied().chain(seams), about, reach)
        };
        let mut share = 1.0;
        let mut facet = cut(share);
        if facet.is_none() {
            facet = Some(cut(0.0)?);
            let (mut most, mut least) = (1.0, 0.0);
            while most - least > PRECISE {
                let middle = 0.5 * (least + most);
                match cut(middle) {
                    Some(found) => (facet, least) = (Some(found), middle),
                    None => most = middle,
                }
            }
            share = least;
        }
        let mut facet = facet?;
        let laid = seams.iter().filter(|(_, by)| *by > 0.0);
        facet.laid = laid.map(|seam| moved(seam, share)).collect();
        Some(facet)
    }

    /// Some points near its edge on `seam`, none if it has none there.
    pub fn edge(&self, seam: &HalfSpace, slack: f64) -> Vec<DVec3> {
        let next = self.corners.iter().cycle().skip(1);
        let on = |x: &DVec3| seam.height(*x).abs() < slack;
        let edges = self.corners.iter().zip(next);
        let edges = edges.filter(|(a, b)| on(a) && on(b) && a.distance(**b) > slack);
        edges
            .flat_map(|(a, b)| [0.02, 0.5, 0.98].map(|share| a.lerp(*b, share)))
            .collect()
    }

    /// Whether what it reaches at `at` (m) along a direction is an edge before a seam.
    fn is_before_seam(&self, lattice: &Lattice, direction: DVec3, at: f64) -> bool {
        let there = |c: &&DVec3| (c.dot(direction) - at).abs() < lattice.tolerance();
        let mut corners = self.corners.iter().filter(there);
        corners.all(|corner| {
            let mut heights = self.laid.iter().map(|seam| seam.height(*corner));
            heights.any(|height| height.abs() < lattice.tolerance())
        })
    }

    /// Points all over it: near its corners and the middles of its edges, and its middle.
    pub fn samples(&self) -> Vec<DVec3> {
        let middle = self.corners.iter().sum::<DVec3>() / self.corners.len() as f64;
        let ends = self.corners.iter().cycle().skip(1);
        let mut samples = vec![middle];
        for (a, b) in self.corners.iter().zip(ends) {
            samples.extend([a.lerp(middle, 0.02), a.midpoint(*b).lerp(middle, 0.02)]);
        }
        samples
    }

    /// From where to where it reaches along a direction, m.
    fn extent(&self, direction: DVec3) -> [f64; 2] {
        let places = self.corners.iter().map(|c| c.dot(direction));
        places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| {
            [low.min(at), high.max(at)]
        })
    }

    /// Whether it lies along an axis and goes beyond the lower and the upper end of the domain there.
    fn passes(&self, lattice: &Lattice, axis: usize) -> [bool; 2] {
        let [low, high] = self.extent(DVec3::AXES[axis]);
        let along = self.plane.normal[axis].abs() < WITHIN;
        [
            along && low <= lattice.low[axis] + lattice.tolerance(),
            along && high >= lattice.high[axis] - lattice.tolerance(),
        ]
    }

    /// Whether it lies along an axis, across all of the domain.
    fn spans(&self, lattice: &Lattice, axis: usize) -> bool {
        self.passes(lattice, axis) == [true; 2]
    }

    /// Points a spacing apart: those of the lattice along an axis that it spans, so that they match the rows
    /// of the fluid and the ends of a period; so too from one end of the domain, where they meet those of a wall, to
    /// an edge of its own; along others evenly from edge to edge, both included.
    pub fn points(&self, lattice: &Lattice) -> Vec<Laid> {
        let spanned = (0..3).find(|axis| self.spans(lattice, *axis));
        let along = match spanned {
            Some(axis) => DVec3::AXES[axis],
            None => self.longest_edge(),
        };
        let across = self.plane.normal.cross(along).normalize();
        // The positive axis if it is one.
        let other = (0..3).find(|axis| across[*axis].abs() > 1.0 - WITHIN);
        let across = other.map_or(across, |axis| DVec3::AXES[axis]);
        let range = self.extent(across);
        let to = |axis: usize, end: f64| match self.is_before_seam(lattice, across, end) {
            true => lattice.row_beside(axis, range, end),
            false => lattice.row_to(axis, range, end),
        };
        let rows = match other.map(|axis| (axis, self.passes(lattice, axis))) {
            Some((axis, [true, true])) => lattice.row(axis, range),
            Some((axis, [true, false])) => to(axis, range[1]),
            Some((axis, [false, true])) => to(axis, range[0]),
            _ => lattice.fitted(range),
        };
        let origin = self.plane.normal * self.plane.distance;
        let mut points = Vec::new();
        for row in rows {
            // Just inside, or rounding would hide one end of an edge that the row runs along.
            let inset = (1e-3 * lattice.tolerance()).min(0.5 * (range[1] - range[0]));
            let inside = row.clamp(range[0] + inset, range[1] - inset);
            let Some(range) = self.section(along, across, inside) else {
                continue;
            };
            let row_points = match spanned {
                Some(axis) => lattice.row(axis, range),
                None => lattice.fitted(range),
            };
            points.extend(row_points.into_iter().map(|at| Laid {
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

    /// Where the line at `row` (m) along `across` enters and leaves, m along `along`.
    fn section(&self, along: DVec3, across: DVec3, row: f64) -> Option<[f64; 2]> {
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        let mut meet = |at: f64| range = [range[0].min(at), range[1].max(at)];
        let next = self.corners.iter().cycle().skip(1);
        for (a, b) in self.corners.iter().zip(next) {
            let (below, above) = (a.dot(across) - row, b.dot(across) - row);
            if below * above > 0.0 {
                continue;
            }
            let (from, to) = (a.dot(along), b.dot(along));
            if below == above {
                meet(from);
                meet(to);
            } else {
                meet(from + (to - from) * (below / (below - above)));
            }
        }
        (range[0] <= range[1]).then_some(range)
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
