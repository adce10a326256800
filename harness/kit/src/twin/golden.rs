//! The golden trajectory: a perturbed flow in a periodic box whose state after 50 steps is known to 15 digits.

use std::f64::consts::TAU;

use super::lattice::{Q, W};
use super::{Config, Domain, Equilibrium, Operator, equilibrium, noise};

/// Number of cells along each axis.
pub const CELLS: [usize; 3] = [12, 10, 8];
/// Number of steps.
pub const STEPS: usize = 50;
/// The body force of the second variant.
pub const FORCE: [f64; 3] = [1e-4, -2e-4, 3e-4];
/// C_w of the third variant.
pub const C_W: f64 = 0.5;

/// Σ f, Σ f² and f_1 at (3, 2, 1), not shifted.
pub type Fingerprint = [f64; 3];
/// Without force or eddy viscosity.
pub const PLAIN: Fingerprint = [MASS, 119.97860279855975, 0.07707931536167875];
/// With [`FORCE`].
pub const FORCED: Fingerprint = [MASS, 119.93706318447632, 0.07853289024989864];
/// With WALE.
pub const WALE: Fingerprint = [MASS, 119.97977770593053, 0.07702011099166237];
/// With the product equilibrium.
pub const PRODUCT: Fingerprint = [MASS, 119.9786011214001, 0.07707880968927251];
const MASS: f64 = 960.092464484255;

/// `Suga` with s5 = 1.9 and the order-2 equilibrium.
pub fn config() -> Config {
    Config {
        operator: Operator::Suga,
        equilibrium: Equilibrium::Order2,
        ..Config::new(1.0 / 1.9)
    }
}

/// Shifted populations of the start: order-2 equilibrium of three crossed shear waves, for any equilibrium of the collision,
/// and noise of 5 % of the weights.
pub fn start() -> Vec<[f64; Q]> {
    let domain = Domain::periodic(CELLS);
    (0..domain.cell_count())
        .map(|cell| {
            let [x, y, z] = domain.position(cell);
            let wave = |at: usize, n: usize| 0.02 * (TAU * at as f64 / n as f64).sin();
            let u = [wave(y, CELLS[1]), wave(z, CELLS[2]), wave(x, CELLS[0])];
            let f = equilibrium::order2(1.0, u);
            let perturbation = noise::populations(cell, 0.05);
            std::array::from_fn(|i| f[i] + perturbation[i])
        })
        .collect()
}

/// The numbers by which states are compared.
pub fn fingerprint(f: &[[f64; Q]]) -> Fingerprint {
    let populations = || f.iter().flat_map(|f| (0..Q).map(|i| f[i] + W[i]));
    let probe = Domain::periodic(CELLS).index([3, 2, 1]);
    [
        populations().sum(),
        populations().map(|f| f * f).sum(),
        f[probe][1] + W[1],
    ]
}
