//! Steady flow along a closed joint from a reduced set of populations: up, rest and down in each row, summed over all else.

use super::solid::{DAMPS, third_order_rate};
use super::{Config, SolidOperator};

/// Sums of the lattice weights over the three directions across a row.
const W: [f64; 3] = [1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0];
/// Steps after which the flow is steady.
const STEPS: usize = 3000;

/// Flow per width over −∇(p/ρ) of `rows` rows between full cells, with B = `weight` for the momentum.
pub fn conductance(config: &Config, operator: SolidOperator, rows: usize, weight: f64) -> f64 {
    let rate = 1.0 / config.tau;
    let third = third_order_rate(config, config.tau);
    // Changes of momentum, shear stress and third moment by the solid alone.
    let solid = match operator {
        SolidOperator::Holdych => [-2.0, 0.0, -2.0],
        SolidOperator::Noble => [-1.0, 0.0, -2.0],
        SolidOperator::Superposition => [-1.0, -rate, -rate],
    };
    let fluid = [0.0, -rate, -third];
    let keep = [weight, DAMPS, DAMPS];
    let factor: [f64; 3] =
        std::array::from_fn(|k| 1.0 + (1.0 - keep[k]) * fluid[k] + keep[k] * solid[k]);
    let collide = |[up, stay, down]: [f64; 3]| {
        let momentum = up + stay + down;
        let kept = factor[0] * momentum;
        let shear = factor[1] * (up - down);
        let third = factor[2] * (up + down - momentum / 3.0);
        let both = third + kept / 3.0;
        [0.5 * (both + shear), kept - both, 0.5 * (both - shear)]
    };
    let mut collided = vec![[0.0; 3]; rows];
    for _ in 0..STEPS {
        let before = collided.clone();
        for (n, after) in collided.iter_mut().enumerate() {
            // Populations returned by a full cell are reversed; those that come along the joint gain momentum from the gradient.
            let up = match n.checked_sub(1) {
                Some(below) => before[below][0] + W[0],
                None => -before[n][2],
            };
            let down = match before.get(n + 1) {
                Some(above) => above[2] + W[2],
                None => -before[n][0],
            };
            *after = collide([up, before[n][1] + W[1], down]);
        }
    }
    // Between two cells along the joint, half of the gradient's contribution has been added.
    let through = |n: usize| {
        let up = if n + 1 < rows {
            collided[n][0] + 0.5 * W[0]
        } else {
            0.0
        };
        let down = if n > 0 {
            collided[n][2] + 0.5 * W[2]
        } else {
            0.0
        };
        up + down + collided[n][1] + 0.5 * W[1]
    };
    (0..rows).map(through).sum()
}

/// B of the momentum for one and for two rows with the flow of a slot of the aperture, by the cubic law.
pub fn weights(config: &Config, operator: SolidOperator, aperture: f64) -> [f64; 2] {
    let wanted = aperture.powi(3) / (12.0 * config.nu());
    [(1, 0.95), (2, 0.98)].map(|(rows, largest)| {
        let (mut low, mut high) = (0.0, largest);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if conductance(config, operator, rows, middle) > wanted {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    })
}
