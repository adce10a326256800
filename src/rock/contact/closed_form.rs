//! Proofs in closed form: a plane or a face that separates two blocks up to rounding, a point on the line of centres, and
//! the contact of a sphere with a sphere or a polyhedron.
//!
//! Nearest point of a convex polyhedron (Goldfarb & Idnani 1983, dual active set, with the identity as Hessian).

use super::{
    ContactGeometry, Placed, Verdict,
    pair::{Pair, Row},
    polygon::spread,
};
use crate::geometry::HalfSpace;
use glam::{DMat3, DVec3};
use std::f64::consts::PI;

impl Placed {
    /// Largest n · v over the block, v from its centroid, m. `length` is |n|.
    pub(super) fn support(&self, n: DVec3, length: f64) -> f64 {
        if self.faces.is_empty() {
            return self.radius * length;
        }
        let heights = self.vertices.iter().map(|v| n.dot(*v));
        heights.fold(f64::NEG_INFINITY, f64::max)
    }
}

impl Pair<'_> {
    /// Verdict of the plane with the normal `n`, from the smaller to the larger block: the
    /// blocks are apart by more than `margin` (in L), or overlap by no more. `n` may have any
    /// length; a zero vector proves nothing.
    pub fn judge(&self, n: DVec3, margin: f64) -> Option<Verdict> {
        let length = n.length();
        if length == 0.0 {
            return None;
        }
        let gap =
            n.dot(self.shift) - self.small.support(n, length) - self.large.support(-n, length);
        proven(gap, margin * self.length * length)
    }

    /// Normal of a face of one block that has the whole other block outside, up to `margin` (in L). It points from
    /// the smaller to the larger block.
    pub fn separating_face(&self, margin: f64) -> Option<DVec3> {
        let margin = margin * self.length;
        let clear = |face: &HalfSpace, shift: DVec3, vertices: &[DVec3]| {
            let height = face.normal.dot(shift) - face.distance + margin;
            // A face that points away from the other block's centroid cannot separate the blocks.
            height > 0.0 && vertices.iter().all(|v| face.normal.dot(*v) >= -height)
        };
        let (small, large) = (self.small, self.large);
        let own = small.faces.iter();
        let mut own = own.filter(|f| clear(f, self.shift, &large.vertices));
        let other = large.faces.iter();
        let mut other = other.filter(|f| clear(f, -self.shift, &small.vertices));
        let found = own.next().map(|f| f.normal);
        found.or_else(|| other.next().map(|f| -f.normal))
    }

    /// A point on the line of centres, in L, which is inside all `rows` if any point of the line is.
    pub fn point_between(&self, rows: &[Row], split: usize) -> DVec3 {
        let line = self.shift / self.length;
        let (own, other) = rows.split_at(split);
        // The line leaves the smaller block at `out`, and enters the larger one at `enter`.
        let out = own.iter().fold(1.0, |s: f64, row| {
            let rate = row.normal.dot(line);
            if rate > 0.0 {
                s.min(row.offset / rate)
            } else {
                s
            }
        });
        let enter = other.iter().fold(0.0, |s: f64, row| {
            let rate = row.normal.dot(line);
            if rate < 0.0 {
                s.max(row.offset / rate)
            } else {
                s
            }
        });
        0.5 * (out + enter) * line
    }
}

/// Verdict of a plane with the gap `gap` at a rounding of `margin`; `None` if it proves nothing.
pub(super) fn proven(gap: f64, margin: f64) -> Option<Verdict> {
    if gap > margin {
        Some(Verdict::Apart)
    } else if gap >= -margin {
        Some(Verdict::Undecided)
    } else {
        None
    }
}

/// Smallest slack b − a · x over all rows.
pub(super) fn smallest_slack(rows: &[Row], x: DVec3) -> f64 {
    let slacks = rows.iter().map(|row| row.offset - row.normal.dot(x));
    slacks.fold(f64::INFINITY, f64::min)
}

/// Gap (m, negative: overlap) and contact of a sphere with another block. The normal points to the sphere.
pub(super) struct Proximity {
    pub gap: f64,
    pub contact: ContactGeometry,
}

/// Two spheres: the section is the circle in which their surfaces intersect.
pub(super) fn sphere_sphere(a: &Placed, b: &Placed) -> Proximity {
    let between = b.centre - a.centre;
    let distance = between.length();
    let normal = (between / distance).normalize_or(DVec3::X);
    // Distance from the first centre to the circle. If it lies beyond a centre, the smaller sphere counts as a whole.
    let (r, q) = (a.radius, b.radius);
    let plane = (distance * distance + (r - q) * (r + q)) / (2.0 * distance);
    let circle = if plane > 0.0 && plane < distance {
        (r - plane) * (r + plane)
    } else {
        r.min(q).powi(2)
    };
    let along = plane.clamp(0.0, distance);
    let point = a.centre + normal * if along.is_nan() { 0.0 } else { along };
    Proximity {
        gap: distance - (r + q),
        contact: round(point, normal, r + q - distance, circle),
    }
}

/// A polyhedron and a sphere: the section is the sphere's circle in the plane through the
/// polyhedron's nearest point, perpendicular to the normal. On a face this is the circle in which the plane
/// of the face cuts the sphere; the edges of the face do not clip it, so that area and force are continuous
/// while the sphere rolls over them.
pub(super) fn sphere_polyhedron(block: &Placed, sphere: &Placed) -> Proximity {
    let centre = sphere.centre - block.centre;
    let top = top_face(block, centre);
    let (normal, distance, foot) = match top.inside {
        true => (top.normal, top.height, centre - top.normal * top.height),
        false => {
            let foot = nearest(&block.faces, centre, top.tolerance);
            let away = centre - foot;
            (away.normalize_or(top.normal), away.length(), foot)
        }
    };
    let radius = sphere.radius;
    let h = distance.max(0.0);
    let circle = ((radius - h) * (radius + h)).clamp(0.0, block.radius.powi(2));
    Proximity {
        gap: distance - radius,
        contact: round(block.centre + foot, normal, radius - distance, circle),
    }
}

/// The point of the surface of a polyhedron next to the point `at`, both from its centroid, m.
pub(in crate::rock) fn nearest_point(block: &Placed, at: DVec3) -> DVec3 {
    let top = top_face(block, at);
    match top.inside {
        true => at - top.normal * top.height,
        false => nearest(&block.faces, at, top.tolerance),
    }
}

/// The face of a polyhedron whose plane a point is highest above.
struct TopFace {
    normal: DVec3,
    /// Height of the point, m; the whole block lies below the plane that is moved by it.
    height: f64,
    /// Rounding of lengths, m.
    tolerance: f64,
    /// Whether the point lies in the block.
    inside: bool,
}

/// The top face under the point `at`, from the centroid, m.
fn top_face(block: &Placed, at: DVec3) -> TopFace {
    let height = |k: usize| block.faces[k].normal.dot(at) - block.faces[k].distance;
    let top =
        (0..block.faces.len()).fold(0, |best, k| if height(k) > height(best) { k } else { best });
    let (height, tolerance) = (
        height(top),
        4.0 * f64::EPSILON * (block.radius + at.length()),
    );
    TopFace {
        normal: block.faces[top].normal,
        height,
        tolerance,
        inside: height <= tolerance,
    }
}

/// A contact over a circle with the squared radius `square` (m²).
fn round(point: DVec3, normal: DVec3, overlap: f64, square: f64) -> ContactGeometry {
    let (x, y) = normal.any_orthonormal_pair();
    ContactGeometry {
        point,
        normal,
        overlap,
        area: PI * square,
        pressure_centre: point,
        width: 2.0 * square.sqrt(),
        spread: spread([x, y], [0.25 * square; 2]),
        limit: 0.0,
    }
}

/// Each pass adds or drops a face and the distance grows, so that no set of faces repeats. More passes than this
/// are due to rounding.
const MAX_PASSES: usize = 200;

/// Squared sine of the angle below which the normal of a face depends linearly on those of the active faces.
const PARALLEL: f64 = 1e-14;

/// Active faces, on which the point lies: a face, an edge, or a corner.
#[derive(Default)]
struct ActiveSet {
    faces: [usize; 3],
    multipliers: [f64; 3],
    count: usize,
}

/// The point of {x : a_k · x ≤ d_k} nearest to `from`, to within `tolerance` (m).
pub(super) fn nearest(faces: &[HalfSpace], from: DVec3, tolerance: f64) -> DVec3 {
    let mut x = from;
    let mut active = ActiveSet::default();
    // The face that is violated most, and its multiplier, until it is active.
    let mut entering: Option<(usize, f64)> = None;
    for _ in 0..MAX_PASSES {
        let violation = |k: usize| faces[k].normal.dot(x) - faces[k].distance;
        let (face, multiplier) = entering.unwrap_or_else(|| {
            let worst = (0..faces.len()).fold(0, |best, k| {
                if violation(k) > violation(best) {
                    k
                } else {
                    best
                }
            });
            (worst, 0.0)
        });
        if violation(face) <= tolerance && entering.is_none() {
            return x;
        }
        let normal = faces[face].normal;
        let shares = active.shares(faces, normal);
        let free = normal - active.sum(faces, shares);
        let rate = free.length_squared();
        let can_move = active.count < 3 && rate > PARALLEL;
        let full = if can_move {
            violation(face) / rate
        } else {
            f64::INFINITY
        };
        let (step_to_release, blocking) = active.first_released(shares);
        let step = full.min(step_to_release);
        if !step.is_finite() {
            return x; // No such point: the faces enclose nothing.
        }
        if can_move {
            x -= step * free;
        }
        for (multiplier, share) in active.multipliers.iter_mut().zip(shares) {
            *multiplier -= step * share;
        }
        if full <= step_to_release {
            active.add(face, multiplier + step);
            entering = None;
        } else {
            active.remove(blocking);
            entering = Some((face, multiplier + step));
        }
    }
    x
}

impl ActiveSet {
    /// Coefficients s of the active normals with Σ s n nearest to `target`.
    fn shares(&self, faces: &[HalfSpace], target: DVec3) -> [f64; 3] {
        let normal = |i: usize| (i < self.count).then(|| faces[self.faces[i]].normal);
        let dot = |i: usize, j: usize| match (normal(i), normal(j)) {
            (Some(a), Some(b)) => a.dot(b),
            _ => f64::from(u8::from(i == j)),
        };
        let column = |j| DVec3::new(dot(0, j), dot(1, j), dot(2, j));
        let gram = DMat3::from_cols(column(0), column(1), column(2));
        let right = DVec3::from_array(std::array::from_fn(|i| {
            normal(i).map_or(0.0, |n| n.dot(target))
        }));
        (gram.inverse() * right).to_array()
    }

    fn sum(&self, faces: &[HalfSpace], shares: [f64; 3]) -> DVec3 {
        let terms = self.faces[..self.count].iter().zip(shares);
        terms.map(|(k, share)| faces[*k].normal * share).sum()
    }

    /// Step at which the first multiplier becomes zero, and its index.
    fn first_released(&self, shares: [f64; 3]) -> (f64, usize) {
        (0..self.count).fold((f64::INFINITY, 0), |best, i| {
            let step_to_release = self.multipliers[i] / shares[i];
            if shares[i] > 0.0 && step_to_release < best.0 {
                (step_to_release, i)
            } else {
                best
            }
        })
    }

    fn add(&mut self, face: usize, multiplier: f64) {
        self.faces[self.count] = face;
        self.multipliers[self.count] = multiplier;
        self.count += 1;
    }

    fn remove(&mut self, place: usize) {
        self.count -= 1;
        self.faces.swap(place, self.count);
        self.multipliers.swap(place, self.count);
    }
}
