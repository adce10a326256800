//! What of a pressure the particles of water leave to a joint.

use crate::particles::{Kernel, Setup};

/// Heights over a face, each of which stands for an equal share of the pressure there.
const HEIGHTS: usize = 8;
/// Steps of the integrals over the kernel function and of the distances of the table of what edges lose: 1e-5 of it.
const STEPS: usize = 128;

/// Pressure p acts on a shell particle j of a block by its pairs with particles i of water, −2p Σ V_i V_j ∇W (Monaghan 2005).
/// Over all that is around a block ∇W adds up to nothing: with water everywhere but in another block nearby, what is missing to p
/// on each of its faces is what the shell of the other one would do to it if that was water too. Two planes with the
/// gap g between them, filled by water, so miss the share
///
/// ```text
/// s(g) = 2 ∫_g^∞ ∫∫ W dx dy dz        1 where they touch, and 0 from the support 2h on
/// ```
///
/// and where one of the blocks goes on beyond the edge of the other by e, so much less, over the width
///
/// ```text
/// c(e) = ½ ∫_e^∞ s dg                 0.21 h where both end there; 0 where one goes on for 2h
/// ```
///
/// There the other one also misses a push of p (c(0) − c(e)) along the face, away from the one that goes on less.
///
/// A block on a wide floor misses s over all of its base; of two with flush sides, one on the other, the edges of
/// the upper one at its top push so much less that without c it would be pushed up by too much.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Across {
    /// m.
    pub heights: [f64; HEIGHTS],
    /// c at the distances n · 2h/STEPS, m.
    lost: Vec<f64>,
    /// 2h, m.
    pub reach: f64,
}

impl Across {
    /// Of the kernel function of such water.
    pub fn new(setup: &Setup) -> Self {
        let h = setup.smoothing * setup.spacing;
        let kernel = match setup.plane {
            true => Kernel::plane(h),
            false => Kernel::space(h),
        };
        let reach = kernel.support();
        let step = reach / STEPS as f64;
        let shares: Vec<f64> = (0..=STEPS)
            .map(|n| share(&kernel, setup.plane, n as f64 * step))
            .collect();
        let mut lost = vec![0.0; STEPS + 1];
        for n in (0..STEPS).rev() {
            lost[n] = lost[n + 1] + 0.25 * step * (shares[n] + shares[n + 1]);
        }
        let height = |n: usize| {
            let target = 1.0 - (n as f64 + 0.5) / HEIGHTS as f64;
            let after = shares.iter().position(|share| *share < target);
            let after = after.unwrap_or(STEPS).max(1);
            let [high, low] = [shares[after - 1], shares[after]];
            step * (after as f64 - (target - low) / (high - low))
        };
        Self {
            heights: std::array::from_fn(height),
            lost,
            reach,
        }
    }

    /// c(e), m.
    pub fn lost(&self, beyond: f64) -> f64 {
        let at = beyond / self.reach * STEPS as f64;
        let n = (at as usize).min(STEPS - 1);
        let part = (at - n as f64).clamp(0.0, 1.0);
        self.lost[n] + part * (self.lost[n + 1] - self.lost[n])
    }

    /// The highest of them, m.
    pub fn far(&self) -> f64 {
        self.heights[HEIGHTS - 1]
    }
}

/// s(g): of spheres, or of circles in a plane, what is farther away than a plane on either side.
fn share(kernel: &Kernel, plane: bool, gap: f64) -> f64 {
    let reach = kernel.support();
    let step = (reach - gap) / STEPS as f64;
    let ring = |n: usize| {
        let r = gap + (n as f64 + 0.5) * step;
        let beyond = match plane {
            true => 4.0 * r * (gap / r).acos(),
            false => 4.0 * std::f64::consts::PI * r * (r - gap),
        };
        beyond * kernel.at(r) * step
    };
    (0..STEPS).map(ring).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn of(plane: bool, smoothing: f64) -> (Setup, Across) {
        let mut setup = Setup::tank(DVec3::ONE, 0.1, 10.0);
        setup.plane = plane;
        setup.smoothing = smoothing;
        let across = Across::new(&setup);
        (setup, across)
    }

    /// ⟨|x|⟩ is 5h/12 in space and 4h/3π in a plane, of which edges lose half, and which is the mean height.
    #[test]
    fn touching_edges_lose_half_the_mean_distance() {
        for (plane, mean) in [
            (false, 5.0 / 12.0),
            (true, 4.0 / (3.0 * std::f64::consts::PI)),
        ] {
            let (_, across) = of(plane, 2.0);
            let lost = across.lost(0.0) / 0.2;
            assert!((lost / (0.5 * mean) - 1.0).abs() < 1e-3, "{plane} {lost}");
            let height = across.heights.iter().sum::<f64>() / HEIGHTS as f64 / 0.2;
            // Eight heights for all.
            assert!((height / mean - 1.0).abs() < 0.02, "{plane} {height}");
            assert_eq!(across.lost(0.5), 0.0);
        }
    }

    /// By pairs of points of two blocks of a square lattice, one over the other with a gap and an edge beyond.
    #[test]
    fn pairs_of_points_push_as_much() {
        let (_, across) = of(true, 2.0);
        let kernel = Kernel::plane(0.2);
        let fine = 0.01;
        // What a block with its corner at the origin, below and to the left of it, does to one over it that ends at −e.
        let push = |gap: f64, beyond: f64| {
            let mut sum = 0.0;
            for nx in 0..80 {
                for nz in 0..40 {
                    let upper = DVec3::new(
                        -beyond - (f64::from(nx) + 0.5) * fine,
                        0.0,
                        gap + (f64::from(nz) + 0.5) * fine,
                    );
                    for mx in (nx - 42).max(0)..(nx + 42).min(120) {
                        for mz in 0..(40 - nz).max(0) {
                            let lower = DVec3::new(
                                -(f64::from(mx) + 0.5) * fine,
                                0.0,
                                -(f64::from(mz) + 0.5) * fine,
                            );
                            let r = upper - lower;
                            let d = 1e-6;
                            let slope =
                                (kernel.at(r.length() + d) - kernel.at(r.length() - d)) / (2.0 * d);
                            sum -= 2.0 * slope * r.z / r.length() * fine.powi(4);
                        }
                    }
                }
            }
            sum
        };
        // Points reach 0.8 from the edge, where all of the lower block is beside them.
        for (gap, beyond) in [(0.0, 0.0), (0.0, 0.1), (0.1, 0.0)] {
            let expected = if gap == 0.0 {
                0.8 - across.lost(beyond)
            } else {
                let higher = across.heights.iter().filter(|height| **height > gap);
                0.8 * higher.count() as f64 / HEIGHTS as f64
            };
            let found = push(gap, beyond);
            // One step of the heights is an eighth, and c is not known at each of them.
            let limit = if gap == 0.0 { 0.005 } else { 0.06 };
            assert!(
                (found - expected).abs() < limit,
                "{gap} {beyond}: {found} {expected}"
            );
        }
    }
}
