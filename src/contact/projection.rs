//! Nearest point of a convex polyhedron (Goldfarb & Idnani 1983, dual active set, for the identity).

use crate::block::HalfSpace;
use glam::{DMat3, DVec3};

/// Each pass adds a face or drops one and the distance grows, so that no set of faces comes twice;
/// passes beyond this are rounding.
const MAX_PASSES: usize = 200;

/// The point of {x : a_k · x ≤ d_k} nearest to `from`, to within `tolerance` (m).
pub(super) fn nearest(faces: &[HalfSpace], from: DVec3, tolerance: f64) -> DVec3 {
    let mut x = from;
    // Faces that hold the point, with their multipliers.
    let mut active: Vec<(usize, f64)> = Vec::with_capacity(4);
    let mut passes = 0;
    loop {
        let violation = |k: usize| faces[k].normal.dot(x) - faces[k].distance;
        let worst = (0..faces.len()).fold(0, |best, k| {
            if violation(k) > violation(best) {
                k
            } else {
                best
            }
        });
        if violation(worst) <= tolerance {
            return x;
        }
        let normal = faces[worst].normal;
        let mut multiplier = 0.0;
        loop {
            passes += 1;
            if passes > MAX_PASSES {
                return x;
            }
            let held: Vec<DVec3> = active.iter().map(|(k, _)| faces[*k].normal).collect();
            let shares = least_squares(&held, normal);
            let own = held.iter().zip(&shares).map(|(n, s)| *n * *s);
            let free = normal - own.sum::<DVec3>();
            let rate = free.length_squared();
            // A face held by three others, or parallel to one, leaves no way to go.
            let full = if rate > 1e-14 {
                (normal.dot(x) - faces[worst].distance) / rate
            } else {
                f64::INFINITY
            };
            let blocking = active.iter().zip(&shares).enumerate().fold(
                (f64::INFINITY, 0),
                |best, (place, ((_, u), share))| {
                    if *share > 0.0 && u / share < best.0 {
                        (u / share, place)
                    } else {
                        best
                    }
                },
            );
            let step = full.min(blocking.0);
            if !step.is_finite() {
                return x;
            }
            if rate > 1e-14 {
                x -= step * free;
            }
            for ((_, u), share) in active.iter_mut().zip(&shares) {
                *u -= step * share;
            }
            multiplier += step;
            if full <= blocking.0 {
                active.push((worst, multiplier));
                break;
            }
            active.remove(blocking.1);
        }
    }
}

/// Shares s of at most three independent `normals` with Σ s n nearest to `target`.
fn least_squares(normals: &[DVec3], target: DVec3) -> Vec<f64> {
    let dot = |i: usize, j: usize| match (normals.get(i), normals.get(j)) {
        (Some(a), Some(b)) => a.dot(*b),
        _ => f64::from(u8::from(i == j)),
    };
    let column = |j| DVec3::new(dot(0, j), dot(1, j), dot(2, j));
    let gram = DMat3::from_cols(column(0), column(1), column(2));
    let right = DVec3::from_array(std::array::from_fn(|i| {
        normals.get(i).map_or(0.0, |n| n.dot(target))
    }));
    let shares = gram.inverse() * right;
    shares.to_array()[..normals.len().min(3)].to_vec()
}
