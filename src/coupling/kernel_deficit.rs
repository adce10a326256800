//! The deficit of the pressure that SPH particles exert where blocks truncate the kernel support.

use crate::sph::{Setup, Wendland};

/// Number of heights over a face, each of which represents an equal fraction of the pressure.
const HEIGHTS: usize = 8;
/// Steps of the integrals over the kernel function and of the table of edge losses, for a relative error of 1e-5.
const STEPS: usize = 128;

/// A pressure p acts on a boundary particle j of a block through its pairs with water particles i, −2p Σ V_i V_j ∇W
/// (Monaghan 2005). The sum of ∇W over the whole neighbourhood of a block vanishes. If water fills it except for another
/// block, the force that is missing on each face is the one that the particles of the other block would exert if
/// they were water. Two planes with a water-filled gap g therefore miss the fraction
///
/// ```text
/// s(g) = 2 ∫_g^∞ ∫∫ W dx dy dz        1 in contact, and 0 beyond the support 2h
/// ```
///
/// of the pressure. Where one of the blocks extends beyond the edge of the other by e, the deficit is reduced over the width
///
/// ```text
/// c(e) = ½ ∫_e^∞ s dg                 0.21 h where both end there; 0 where one extends by 2h
/// ```
///
/// There the other block also misses a lateral force p (c(0) − c(e)) per length, away from the block that extends less.
///
/// A block on a wide floor misses s over its whole base. For two stacked blocks with flush sides, uplift without c would be
/// too large, because the edges of the joint already receive a part of the pressure.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct KernelDeficit {
    /// Heights over a face where the deficit takes evenly spaced values, m.
    pub heights: [f64; HEIGHTS],
    /// c at the distances n · 2h/STEPS, m.
    losses: Vec<f64>,
    /// 2h, m.
    pub support: f64,
}

impl KernelDeficit {
    /// The deficit of the kernel function of `setup`.
    pub fn new(setup: &Setup) -> Self {
        let kernel = setup.kernel();
        let support = kernel.support();
        let step = support / STEPS as f64;
        let deficits: Vec<f64> = (0..=STEPS)
            .map(|n| deficit(&kernel, setup.plane, n as f64 * step))
            .collect();
        let mut losses = vec![0.0; STEPS + 1];
        for n in (0..STEPS).rev() {
            losses[n] = losses[n + 1] + 0.25 * step * (deficits[n] + deficits[n + 1]);
        }
        let height = |n: usize| {
            let target = 1.0 - (n as f64 + 0.5) / HEIGHTS as f64;
            let after = deficits.iter().position(|deficit| *deficit < target);
            let after = after.unwrap_or(STEPS).max(1);
            let [high, low] = [deficits[after - 1], deficits[after]];
            step * (after as f64 - (target - low) / (high - low))
        };
        Self {
            heights: std::array::from_fn(height),
            losses,
            support,
        }
    }

    /// Width c(e) over which an edge reduces the deficit, m; `extent` is e (m).
    pub fn edge_loss(&self, extent: f64) -> f64 {
        let at = extent / self.support * STEPS as f64;
        let n = (at as usize).min(STEPS - 1);
        let part = (at - n as f64).clamp(0.0, 1.0);
        self.losses[n] + part * (self.losses[n + 1] - self.losses[n])
    }

    /// The largest height, m.
    pub fn max_height(&self) -> f64 {
        self.heights[HEIGHTS - 1]
    }
}

/// s(g): the kernel integral over spherical caps, or circular segments in a plane, beyond planes at ±g.
fn deficit(kernel: &Wendland, plane: bool, gap: f64) -> f64 {
    let step = (kernel.support() - gap) / STEPS as f64;
    let ring = |n: usize| {
        let r = gap + (n as f64 + 0.5) * step;
        let beyond = if plane {
            4.0 * r * (gap / r).acos()
        } else {
            4.0 * std::f64::consts::PI * r * (r - gap)
        };
        beyond * kernel.at(r) * step
    };
    (0..STEPS).map(ring).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn of(plane: bool, smoothing: f64) -> (Setup, KernelDeficit) {
        let mut setup = Setup::tank(DVec3::ONE, 0.1, 10.0);
        setup.plane = plane;
        setup.smoothing = smoothing;
        let deficit = KernelDeficit::new(&setup);
        (setup, deficit)
    }

    /// ⟨|x|⟩ is 5h/12 in space and 4h/3π in a plane. Edges lose half of it, and it is the mean height.
    #[test]
    fn edges_in_contact_lose_half_the_mean_distance() {
        for (plane, mean) in [
            (false, 5.0 / 12.0),
            (true, 4.0 / (3.0 * std::f64::consts::PI)),
        ] {
            let (_, deficit) = of(plane, 2.0);
            let lost = deficit.edge_loss(0.0) / 0.2;
            assert!((lost / (0.5 * mean) - 1.0).abs() < 1e-3, "{plane} {lost}");
            let height = deficit.heights.iter().sum::<f64>() / HEIGHTS as f64 / 0.2;
            // Discretised by eight heights.
            assert!((height / mean - 1.0).abs() < 0.02, "{plane} {height}");
            assert_eq!(deficit.edge_loss(0.5), 0.0);
        }
    }

    /// Reference: the sum over pairs of lattice points of two blocks, one over the other with a gap and an offset edge.
    #[test]
    fn deficit_matches_a_sum_over_pairs_of_points() {
        let (_, deficit) = of(true, 2.0);
        let kernel = Wendland::plane(0.2);
        let fine = 0.01;
        // Force of a block below and to the left of the origin on one above it that ends at −e.
        let force = |gap: f64, extent: f64| {
            let mut sum = 0.0;
            for nx in 0..80 {
                for nz in 0..40 {
                    let upper = DVec3::new(
                        -extent - (f64::from(nx) + 0.5) * fine,
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
        // Points reach 0.8 from the edge; there the lower block fills their support.
        for (gap, extent) in [(0.0, 0.0), (0.0, 0.1), (0.1, 0.0)] {
            let expected = if gap == 0.0 {
                0.8 - deficit.edge_loss(extent)
            } else {
                let higher = deficit.heights.iter().filter(|height| **height > gap);
                0.8 * higher.count() as f64 / HEIGHTS as f64
            };
            let found = force(gap, extent);
            // One height represents an eighth; c is tabulated at contact only.
            let limit = if gap == 0.0 { 0.005 } else { 0.06 };
            assert!(
                (found - expected).abs() < limit,
                "{gap} {extent}: {found} {expected}"
            );
        }
    }
}
