//! A convex cell under construction: planes, vertices and rings, clipped by one plane after another.
//!
//! Volume, centroid and inertia of the region that triangles enclose, exact up to rounding: the sum over signed
//! tetrahedra from the origin (Tonon 2004, J. Math. Stat. 1:8; the same integrals as Mirtich 1996, J. Graph. Tools
//! 1:31).

use super::{HalfSpace, bounding_box, pose::outer};
use glam::{DMat3, DVec3};

/// Distance, relative to the size of a cell, within which a vertex counts as on a plane: a thousand times the
/// rounding of its coordinates, so that rounding does not decide the classification.
pub(super) const ON: f64 = 1e-12;

/// Source of the faces of the box from which a cell starts.
pub(super) const START: u32 = u32::MAX;

/// A face of a cell.
#[derive(Clone, Debug)]
pub(super) struct Facet {
    pub plane: HalfSpace,
    /// Identifier of the plane, given by the caller, or [`START`].
    pub source: u32,
    /// Vertices, counter-clockwise seen from outside.
    pub ring: Vec<u32>,
}

/// Intersection of the cutting plane with an edge, and the facets on both sides of the edge.
struct Crossing {
    edge: [u32; 2],
    facets: [usize; 2],
}

/// Smallest triple product of three unit normals for which the common point of the planes is well defined.
pub(super) const PARALLEL: f64 = 1e-6;

/// A convex cell. Vertices that no ring uses any more are NaN until the next [`Cell::compact`].
#[derive(Clone, Debug)]
pub(super) struct Cell {
    pub vertices: Vec<DVec3>,
    pub facets: Vec<Facet>,
    dead: usize,
}

/// Part of a cell that remains after clipping by a plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Clip {
    /// The whole cell: no vertex is outside, and the plane is redundant.
    All,
    /// Nothing: no vertex is inside.
    Nothing,
    /// A part of the cell; the plane is now a face.
    Part,
}

impl Cell {
    /// A cell from vertices and facets, which must be closed and convex.
    pub fn new(vertices: Vec<DVec3>, facets: Vec<Facet>) -> Self {
        Self {
            vertices,
            facets,
            dead: 0,
        }
    }

    /// The box between two corners.
    pub fn cuboid(min: DVec3, max: DVec3) -> Self {
        let vertex = |i: u32| {
            let pick = |axis: usize| [min[axis], max[axis]][(i >> axis & 1) as usize];
            DVec3::new(pick(0), pick(1), pick(2))
        };
        let facet = |normal: DVec3, distance: f64, ring: [u32; 4]| Facet {
            plane: HalfSpace { normal, distance },
            source: START,
            ring: ring.to_vec(),
        };
        let facets = vec![
            facet(DVec3::NEG_X, -min.x, [0, 4, 6, 2]),
            facet(DVec3::X, max.x, [1, 3, 7, 5]),
            facet(DVec3::NEG_Y, -min.y, [0, 1, 5, 4]),
            facet(DVec3::Y, max.y, [2, 6, 7, 3]),
            facet(DVec3::NEG_Z, -min.z, [0, 2, 3, 1]),
            facet(DVec3::Z, max.z, [4, 5, 7, 6]),
        ];
        Self::new((0..8).map(vertex).collect(), facets)
    }

    /// Removes the part outside `plane`; vertices nearer to the plane than `on` (m) count as on it.
    ///
    /// The rim of the clipped faces becomes the ring of the new face, so that the surface stays closed despite
    /// rounding. If rounding splits the rim into more than one ring, the cut is repeated with a larger `on`.
    pub fn clip(&mut self, plane: HalfSpace, source: u32, on: f64) -> Clip {
        let heights: Vec<f64> = self.vertices.iter().map(|v| plane.height(*v)).collect();
        // Comparisons with the NaN of dead vertices are false: they are neither outside nor inside.
        let mut on = on;
        loop {
            if !heights.iter().any(|h| *h > on) {
                return Clip::All;
            }
            if !heights.iter().any(|h| *h < -on) {
                return Clip::Nothing;
            }
            if self.cut(plane, source, on, &heights) {
                return Clip::Part;
            }
            on *= 8.0;
        }
    }

    /// Both parts of the cell if the plane divides it: the inner one, with `plane` as its last face, and the outer
    /// one, with the exactly opposite plane. The vertices of the section are bitwise equal in both.
    pub fn split(&self, plane: HalfSpace, source: u32, on: f64) -> Option<(Self, Self)> {
        let mut inside = self.clone();
        if inside.clip(plane, source, on) != Clip::Part {
            return None;
        }
        let mut outside = self.clone();
        // Heights are exactly opposite, so vertices are classified in the same manner.
        outside.clip(plane.opposite(), source, on);
        Some((inside, outside))
    }

    /// Clips the cell and returns true; returns false, without changes, if the rim is not one ring.
    fn cut(&mut self, plane: HalfSpace, source: u32, on: f64, heights: &[f64]) -> bool {
        let outside = |v: u32| heights[v as usize] > on;
        let inside = |v: u32| heights[v as usize] < -on;
        let mut fresh: Vec<Crossing> = Vec::new();
        let mut rim: Vec<[u32; 2]> = Vec::new();
        let mut changed: Vec<(usize, Vec<u32>)> = Vec::new();
        let old = self.vertices.len() as u32;
        let is_on = |v: u32| v >= old || (!inside(v) && !outside(v));
        for (index, facet) in self.facets.iter().enumerate() {
            if !facet.ring.iter().any(|v| inside(*v)) {
                changed.push((index, Vec::new()));
                continue;
            }
            let mut ring = Vec::with_capacity(facet.ring.len() + 1);
            for (i, &a) in facet.ring.iter().enumerate() {
                let b = facet.ring[(i + 1) % facet.ring.len()];
                if !outside(a) {
                    ring.push(a);
                }
                if inside(a) && outside(b) || outside(a) && inside(b) {
                    let edge = [a.min(b), a.max(b)];
                    let known = fresh.iter().position(|c| c.edge == edge);
                    let which = known.unwrap_or_else(|| {
                        fresh.push(Crossing {
                            edge,
                            facets: [index, index],
                        });
                        fresh.len() - 1
                    });
                    fresh[which].facets[1] = index;
                    ring.push(old + which as u32);
                }
            }
            for (i, &a) in ring.iter().enumerate() {
                let b = ring[(i + 1) % ring.len()];
                if is_on(a) && is_on(b) {
                    match rim.iter().position(|e| *e == [b, a]) {
                        Some(twin) => drop(rim.swap_remove(twin)),
                        None => rim.push([a, b]),
                    }
                }
            }
            if ring != facet.ring {
                changed.push((index, ring));
            }
        }
        let Some(ring) = chain(&rim) else {
            return false;
        };
        let fresh: Vec<DVec3> = fresh
            .iter()
            .map(|c| self.crossing(c, &plane, heights))
            .collect();
        for (index, ring) in changed {
            self.facets[index].ring = ring;
        }
        self.facets.retain(|facet| !facet.ring.is_empty());
        self.facets.push(Facet {
            plane,
            source,
            ring,
        });
        for (vertex, height) in self.vertices.iter_mut().zip(heights) {
            if *height > on {
                *vertex = DVec3::NAN;
                self.dead += 1;
            }
        }
        self.vertices.extend(fresh);
        if 2 * self.dead > self.vertices.len() {
            self.compact();
        }
        true
    }

    /// Intersection of an edge with the plane, as the common point of the plane and the two facets of the edge. If
    /// these planes are nearly parallel, interpolates along the edge; always doing so would accumulate errors.
    fn crossing(&self, crossing: &Crossing, plane: &HalfSpace, heights: &[f64]) -> DVec3 {
        let [a, b] = crossing.edge.map(|v| self.vertices[v as usize]);
        let [ha, hb] = crossing.edge.map(|v| heights[v as usize]);
        let between = a + (b - a) * (ha / (ha - hb));
        let [p, q] = crossing.facets.map(|f| self.facets[f].plane);
        meet([p, q, *plane], between).unwrap_or(between)
    }

    /// Drops the vertices that no ring uses.
    pub fn compact(&mut self) {
        let mut new = vec![u32::MAX; self.vertices.len()];
        let mut kept = Vec::with_capacity(self.vertices.len());
        for v in self.facets.iter_mut().flat_map(|f| &mut f.ring) {
            let slot = &mut new[*v as usize];
            if *slot == u32::MAX {
                *slot = kept.len() as u32;
                kept.push(self.vertices[*v as usize]);
            }
            *v = *slot;
        }
        self.vertices = kept;
        self.dead = 0;
    }

    /// The vertices in use.
    pub fn live(&self) -> impl Iterator<Item = DVec3> {
        self.vertices.iter().copied().filter(|v| !v.is_nan())
    }

    /// Lower and upper corner of the bounding box.
    pub fn bounds(&self) -> [DVec3; 2] {
        bounding_box(self.live())
    }

    /// Moves each vertex of a compact cell to the common point of three of its planes, chosen by `widest`. While a
    /// cell is cut, a vertex keeps the common point of its first three planes, however flat their angle.
    pub(super) fn settle(&mut self) {
        let count = self.vertices.len();
        let mut ends = vec![0_usize; count + 1];
        for v in self.facets.iter().flat_map(|f| &f.ring) {
            ends[*v as usize + 1] += 1;
        }
        for v in 0..count {
            ends[v + 1] += ends[v];
        }
        let mut next = ends.clone();
        let mut planes = vec![0_usize; ends[count]];
        for (index, facet) in self.facets.iter().enumerate() {
            for v in &facet.ring {
                planes[next[*v as usize]] = index;
                next[*v as usize] += 1;
            }
        }
        for v in 0..count {
            let plane = |i: &usize| self.facets[*i].plane;
            let own: Vec<HalfSpace> = planes[ends[v]..ends[v + 1]].iter().map(plane).collect();
            if let Some(best) = widest(&own) {
                self.vertices[v] = meet(best, self.vertices[v]).unwrap_or(self.vertices[v]);
            }
        }
    }

    /// Volume integrals about `origin`.
    pub(super) fn moments(&self, origin: DVec3) -> Moments {
        let at = |v: u32| self.vertices[v as usize] - origin;
        Moments::of(self.facets.iter().flat_map(|facet| {
            let pairs = facet.ring[1..].windows(2);
            pairs.map(move |pair| [at(facet.ring[0]), at(pair[0]), at(pair[1])])
        }))
    }

    /// The centroid of a compact cell; `None` if the cell has no volume.
    pub(super) fn centroid(&self) -> Option<DVec3> {
        let middle = self.vertices.iter().sum::<DVec3>() / self.vertices.len() as f64;
        let moments = self.moments(middle);
        let centroid = middle + moments.centroid();
        (moments.volume > 0.0 && centroid.is_finite()).then_some(centroid)
    }
}

/// The ring of the edges of `rim`, each in reverse; `None` if they are not exactly one ring.
fn chain(rim: &[[u32; 2]]) -> Option<Vec<u32>> {
    let [end, start] = *rim.first()?;
    let mut ring = vec![start];
    let mut at = end;
    while at != start {
        if ring.len() >= rim.len() {
            return None;
        }
        ring.push(at);
        at = rim.iter().find(|[_, to]| *to == at)?[0];
    }
    (ring.len() == rim.len() && ring.len() >= 3).then_some(ring)
}

/// The two planes nearest to a right angle, and the third with the largest triple product with them.
fn widest(planes: &[HalfSpace]) -> Option<[HalfSpace; 3]> {
    if let [p, q, r] = planes {
        return Some([*p, *q, *r]);
    }
    let pairs = planes.iter().enumerate().flat_map(|(i, p)| {
        let later = planes[i + 1..].iter();
        later.map(move |q| (p.normal.cross(q.normal), p, q))
    });
    let (across, p, q) =
        pairs.max_by(|(a, ..), (b, ..)| a.length_squared().total_cmp(&b.length_squared()))?;
    let span = |r: &HalfSpace| across.dot(r.normal).abs();
    let third = planes.iter().max_by(|a, b| span(a).total_cmp(&span(b)))?;
    Some([*p, *q, *third])
}

/// The common point of three planes, computed from a point `near` it so that distances are small; `None` if the
/// planes are nearly parallel to one line.
pub(super) fn meet([p, q, r]: [HalfSpace; 3], near: DVec3) -> Option<DVec3> {
    let across = p.normal.cross(q.normal);
    let det = across.dot(r.normal);
    if det.abs() < PARALLEL {
        return None;
    }
    let [hp, hq, hr] = [p, q, r].map(|plane| plane.height(near));
    let sum = q.normal.cross(r.normal) * hp + r.normal.cross(p.normal) * hq + across * hr;
    Some(near - sum / det)
}

/// ∫dV, ∫x dV and ∫x xᵀ dV.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moments {
    /// Volume, m³.
    pub volume: f64,
    first: DVec3,
    second: DMat3,
}

impl Moments {
    /// Moments of the region enclosed by triangles: counter-clockwise seen from outside, m from a point near their middle.
    pub fn of(triangles: impl Iterator<Item = [DVec3; 3]>) -> Self {
        let nothing = Self {
            volume: 0.0,
            first: DVec3::ZERO,
            second: DMat3::ZERO,
        };
        triangles.fold(nothing, |sum, [a, b, c]| {
            let det = a.dot(b.cross(c));
            let s = a + b + c;
            let square = outer(s, s) + outer(a, a) + outer(b, b) + outer(c, c);
            Self {
                volume: sum.volume + det / 6.0,
                first: sum.first + s * (det / 24.0),
                second: sum.second + square * (det / 120.0),
            }
        })
    }

    /// Centroid, m.
    pub fn centroid(&self) -> DVec3 {
        self.first / self.volume
    }

    /// Inertia tensor about the origin for a density of one, m⁵.
    pub fn inertia(&self) -> DMat3 {
        let c = self.second;
        DMat3::IDENTITY * (c.x_axis.x + c.y_axis.y + c.z_axis.z) - c
    }
}
