//! The f64 twin against exact results: golden trajectory, collision, forcing, decay and stability of a periodic box.

#![allow(
    clippy::needless_range_loop,
    reason = "indices are those of the formulas"
)]

use std::f64::consts::TAU;

use kit::twin::{
    self, Config, Domain, Equilibrium, Force, OddClass, Operator, Twin, collide, equilibrium,
    golden, noise,
};
use kit::{
    assert_near,
    twin::lattice::{C, OPPOSITE, Q, W, macroscopic},
};
use kit::{
    assert_relative,
    twin::moments::{self, exact_data, rational, scalar_product},
};

/// Populations far from equilibrium with ρ ≈ 1 and |u| ≈ 0.1.
fn random_populations(seed: usize) -> [f64; Q] {
    noise::populations(seed, 0.4)
}

#[test]
fn golden_trajectories() {
    let plain = || {
        let mut flow = Twin::new(Domain::periodic(golden::CELLS), golden::config());
        flow.f = golden::start();
        flow
    };
    let (mut forced, mut wale, mut product) = (plain(), plain(), plain());
    forced.force = Force::Uniform(golden::FORCE);
    wale.config.c_w = Some(golden::C_W);
    product.config.equilibrium = Equilibrium::Product;
    for (mut flow, reference) in [
        (plain(), golden::PLAIN),
        (forced, golden::FORCED),
        (wale, golden::WALE),
        (product, golden::PRODUCT),
    ] {
        flow.run(golden::STEPS);
        for (value, expected) in golden::fingerprint(&flow.f).into_iter().zip(reference) {
            // Both sides are f64: 960 · 27 terms and 50 steps of round-off at 1e-16 each.
            assert_relative(value, expected, 1e-13);
        }
    }
}

#[test]
fn lattice_is_the_published_one() {
    let data = exact_data();
    for i in 0..Q {
        let c = [0, 1, 2].map(|axis| data["c"][i][axis].as_i64().unwrap() as i32);
        assert_eq!(C[i], c);
        assert_eq!(C[OPPOSITE[i]], c.map(|component| -component));
        assert_near(W[i], rational(data["w"][i].as_str().unwrap()), 1e-16);
    }
}

#[test]
fn moments_of_equilibria_and_source_are_the_published_formulas() {
    let (rho, u, force) = (1.03, [0.07, -0.04, 0.11], [2e-3, -3e-3, 1e-3]);
    // The populations are shifted, the formulas are not.
    let weights = moments::suga().moments(&W);
    let none = [0.0; Q];
    let cases = [
        ("meq_order2", equilibrium::order2(rho, u), &weights),
        ("meq_product", equilibrium::product(rho, u), &weights),
        ("guo_moments", twin::collide::guo_source(u, force), &none),
    ];
    let [[u_x, u_y, u_z], [f_x, f_y, f_z]] = [u, force];
    let values = [
        ("rho", rho),
        ("u_x", u_x),
        ("u_y", u_y),
        ("u_z", u_z),
        ("F_x", f_x),
        ("F_y", f_y),
        ("F_z", f_z),
    ];
    for (table, f, shift) in cases {
        let m = moments::suga().moments(&f);
        for k in 0..Q {
            let name = exact_data()["names"][k].as_str().unwrap();
            let formula = exact_data()[table][name].as_str().unwrap();
            let expected = evaluate(formula, &values);
            let error = (m[k] + shift[k] - expected).abs();
            assert!(error < 1e-14, "{table} {name}: {error}");
        }
    }
}

/// Value of a formula in the notation of the data file.
fn evaluate(formula: &str, values: &[(&str, f64)]) -> f64 {
    use exmex::Express;
    let expression = exmex::parse::<f64>(&formula.replace("**", "^")).unwrap();
    let arguments: Vec<f64> = expression
        .var_names()
        .iter()
        .map(|name| values.iter().find(|(known, _)| known == name).unwrap().1)
        .collect();
    expression.eval(&arguments).unwrap()
}

#[test]
fn hermite_moments_are_tensor_hermite_polynomials_up_to_sums_and_differences() {
    let basis = moments::hermite();
    for a in 0..Q {
        for b in 0..a {
            let product = scalar_product(&W, &basis.rows[a], &basis.rows[b]);
            assert!(product.abs() < 1e-13, "rows {a} and {b}: {product}");
        }
    }
    // The moments H_abc with 1, x, x² − 1/3 that an orthogonal row may contain, by its relaxation rate.
    let orders: [(std::ops::RangeInclusive<usize>, &[[u32; 3]]); 10] = [
        (4..=4, &[[2, 0, 0]]),
        (5..=6, &[[2, 0, 0]]),
        (7..=9, &[[1, 1, 0]]),
        (10..=12, &[[2, 1, 0]]),
        (13..=15, &[[2, 2, 1]]),
        (16..=16, &[[2, 2, 0]]),
        (17..=17, &[[2, 2, 2]]),
        (18..=19, &[[2, 2, 0]]),
        (20..=22, &[[2, 1, 1]]),
        (23..=25, &[[2, 1, 0]]),
    ];
    for (rows, allowed) in orders {
        for k in rows {
            for order in every_order() {
                let overlap = scalar_product(&W, &basis.rows[k], &tensor_hermite(order));
                let mut kind = order;
                kind.sort_by(|a, b| b.cmp(a));
                if !allowed.contains(&kind) {
                    assert!(overlap.abs() < 1e-13, "row {k} contains {order:?}");
                }
            }
        }
    }
    // 10–12 take the sum 120 + 102, 23–25 the difference.
    for (row, sign) in [(10, 1.0), (23, -1.0)] {
        let part = |order| scalar_product(&W, &basis.rows[row], &tensor_hermite(order));
        let (first, second) = (part([1, 2, 0]), part([1, 0, 2]));
        assert!(first.abs() > 1e-3 && (first - sign * second).abs() < 1e-14);
    }
}

fn every_order() -> impl Iterator<Item = [u32; 3]> {
    (0..27).map(|n| [n % 3, n / 3 % 3, n / 9])
}

fn tensor_hermite(order: [u32; 3]) -> [f64; Q] {
    std::array::from_fn(|i| {
        (0..3)
            .map(|axis| {
                let c = f64::from(C[i][axis]);
                match order[axis] {
                    0 => 1.0,
                    1 => c,
                    _ => c * c - 1.0 / 3.0,
                }
            })
            .product()
    })
}

#[test]
fn collision_keeps_mass_and_gains_the_force_in_momentum() {
    let force = [1e-3, -2e-3, 3e-3];
    for operator in [Operator::Bgk, Operator::Suga, Operator::Hermite] {
        for odd in [OddClass::Bulk, OddClass::Wall] {
            let config = Config {
                operator,
                ..Config::new(0.6)
            };
            let f = random_populations(3);
            let after = collide(&config, &f, force, 0.01, odd);
            let ((rho, u), (rho_after, u_after)) =
                (macroscopic(&f, [0.0; 3]), macroscopic(&after, [0.0; 3]));
            assert_near(rho_after, rho, 1e-15);
            for axis in 0..3 {
                let gain = rho_after * u_after[axis] - rho * u[axis];
                assert_near(gain, force[axis], 1e-15);
            }
        }
    }
}

/// Apparent viscosity over nominal of a shear wave along x that is advected at U along x.
fn apparent_viscosity(kind: Equilibrium, speed: f64) -> f64 {
    let (n, steps) = (48, 400);
    let config = Config {
        equilibrium: kind,
        ..Config::new(0.8)
    };
    let mut flow = Twin::new(Domain::periodic([n, 1, 1]), config);
    let k = TAU / n as f64;
    let u: Vec<[f64; 3]> = (0..n)
        .map(|x| [speed, 1e-4 * (k * x as f64).sin(), 0.0])
        .collect();
    flow.start(&vec![1.0; n], &u);
    let amplitude = |flow: &Twin| {
        let (mut sine, mut cosine) = (0.0, 0.0);
        for (x, u) in flow.velocity().iter().enumerate() {
            sine += u[1] * (k * x as f64).sin();
            cosine += u[1] * (k * x as f64).cos();
        }
        sine.hypot(cosine)
    };
    let first = amplitude(&flow);
    flow.run(steps);
    (first / amplitude(&flow)).ln() / (k * k * steps as f64) / config.nu()
}

#[test]
fn product_equilibrium_restores_galilean_invariance_of_viscosity() {
    // Order 2 lacks the u³ term, so that the viscosity is 1 − 3U² of nominal; k² = 0.017 leaves 1e-3 of discretisation.
    for speed in [0.1, 0.2] {
        let order2 = apparent_viscosity(Equilibrium::Order2, speed);
        assert_near(order2, 1.0 - 3.0 * speed * speed, 3e-3);
        let product = apparent_viscosity(Equilibrium::Product, speed);
        assert_near(product, 1.0, 3e-3);
    }
}

/// Root mean square of the populations about their mean after `steps`, relative to the start, in a quiescent box of 16³
/// cells with noise of 1e-6.
fn growth_of_noise(config: Config, steps: usize) -> f64 {
    let mut flow = Twin::new(Domain::periodic([16; 3]), config);
    for cell in 0..flow.domain.cell_count() {
        flow.f[cell] = noise::populations(cell, 1e-6);
    }
    let spread = |flow: &Twin| {
        let cells = flow.domain.cell_count() as f64;
        (0..Q)
            .map(|i| {
                let mean = flow.f.iter().map(|f| f[i]).sum::<f64>() / cells;
                flow.f.iter().map(|f| (f[i] - mean).powi(2)).sum::<f64>()
            })
            .sum::<f64>()
            .sqrt()
    };
    let first = spread(&flow);
    flow.run(steps);
    spread(&flow) / first
}

#[test]
fn quiescent_noise_decays_with_hermite_moments() {
    let growth = growth_of_noise(Config::new(1.0), 60);
    assert!(growth < 0.1, "{growth}");
}

#[test]
fn quiescent_noise_grows_with_the_published_moments_above_their_bound() {
    // 7.4 % per step at τ = 1 once the unstable mode has emerged from the decaying rest.
    let config = Config {
        operator: Operator::Suga,
        ..Config::new(1.0)
    };
    let growth = growth_of_noise(config, 150);
    assert!(growth > 100.0, "{growth}");
}
