//! Nearest point of a convex polyhedron (Goldfarb & Idnani 1983, dual active set, for the identity).

use crate::geometry::HalfSpace;
use glam::{DMat3, DVec3};

/// Each pass adds a face or drops one and the distance grows, so that no set of faces comes twice;
/// passes beyond this are rounding.
const MAX_PASSES: usize = 200;

/// Square of the sine of the angle below which a face is held by the others already.
const PARALLEL: f64 = 1e-14;

/// Faces that hold the point: on a face, an edge, or a corner.
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
    // The face that is violated most, and its multiplier, until it is held.
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
    /// Shares s of the held normals with Σ s n nearest to `target`.
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

    /// How far the multipliers can go before one is zero, and which.
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
