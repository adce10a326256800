//! Affine bodies alone: critical step and gradient of the energy. `riprap validate`, dda, covers their motion.

use glam::{DMat3, DVec3};
use riprap::rock::{
    integrate::{Affine, Wrench},
    law::Elastic,
};

const DENSITY: f64 = 2500.0;
const ROCK: Elastic = Elastic {
    youngs_modulus: 1e9,
    poissons_ratio: 0.25,
};
const NONE: Wrench = Wrench {
    force: DVec3::ZERO,
    moment: DMat3::ZERO,
};

/// ∫ X Xᵀ dV of a box about its centre, m⁵.
fn second(edges: DVec3) -> DMat3 {
    DMat3::from_diagonal(edges * edges * (edges.x * edges.y * edges.z / 12.0))
}

fn cuboid(x: f64, y: f64, z: f64, initial_stress: DMat3) -> Affine {
    let edges = DVec3::new(x, y, z);
    let c = second(edges);
    let trace = c.x_axis.x + c.y_axis.y + c.z_axis.z;
    let inertia = DMat3::IDENTITY * trace - c;
    Affine::new(x * y * z, inertia, DENSITY, ROCK, initial_stress)
}

fn norm(a: DMat3) -> f64 {
    let columns = [a.x_axis, a.y_axis, a.z_axis];
    columns
        .iter()
        .map(|c| c.length_squared())
        .sum::<f64>()
        .sqrt()
}

/// Pseudo-random numbers between −1 and 1: fractions of multiples of the golden ratio.
fn noise(seed: u32) -> DMat3 {
    let entry = |k: u32| 2.0 * (f64::from(9 * seed + k + 1) * 0.618_033_988_75).fract() - 1.0;
    DMat3::from_cols_array(&std::array::from_fn(|k| entry(k as u32)))
}

/// Largest eigenvalue of the nine-by-nine problem, by power iteration on M⁻¹K in its textbook form:
/// K δF = V (λ tr ε · 1 + 2μ ε) with ε the symmetric part of δF, M δF = ρ δF C.
fn largest_eigenvalue(edges: DVec3) -> f64 {
    let (lambda, mu) = (4e8, 4e8);
    let volume = edges.x * edges.y * edges.z;
    let inverse = (second(edges) * DENSITY).inverse();
    let mut v = noise(3);
    let mut value = 0.0;
    for _ in 0..20_000 {
        let strain = (v + v.transpose()) * 0.5;
        let trace = strain.x_axis.x + strain.y_axis.y + strain.z_axis.z;
        let next = (DMat3::IDENTITY * (lambda * trace) + strain * (2.0 * mu)) * volume * inverse;
        value = norm(next) / norm(v);
        v = next * norm(next).recip();
    }
    value
}

#[test]
fn the_critical_step_is_that_of_the_nine_by_nine_problem() {
    for edges in [
        DVec3::new(1.0, 2.0, 3.0),
        DVec3::new(0.3, 5.0, 0.4),
        DVec3::splat(2.0),
    ] {
        let body = cuboid(edges.x, edges.y, edges.z, DMat3::ZERO);
        let expected = 2.0 / largest_eigenvalue(edges).sqrt();
        let error = body.critical_step() / expected - 1.0;
        assert!(error.abs() < 1e-12, "{edges}: {error}");
    }
}

#[test]
fn the_bound_of_the_frequency_holds_under_strain_and_stress() {
    let stress = DMat3::from_diagonal(DVec3::new(3e7, -5e6, 1e7));
    let body = cuboid(1.0, 2.0, 3.0, stress);
    let s = second(DVec3::new(1.0, 2.0, 3.0)) * DENSITY;
    let inner = |a: DMat3, b: DMat3| {
        let (a, b) = (a.to_cols_array(), b.to_cols_array());
        a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>()
    };
    let mut highest = 0.0f64;
    for seed in 0..20 {
        let f = DMat3::IDENTITY + noise(seed) * 0.03;
        let bound = body.frequency_squared(f);
        let mut v = noise(seed + 50);
        // −∂F̈/∂F is symmetric with respect to S: power iteration, shifted so that no negative value is the largest.
        for _ in 0..200 {
            let h = 1e-6 / norm(v);
            let ahead = body.accelerations(f + v * h, &NONE).1;
            let behind = body.accelerations(f - v * h, &NONE).1;
            let next = (behind - ahead) * (0.5 / h);
            let quotient = inner(v * s, next) / inner(v * s, v);
            assert!(quotient <= bound, "{quotient} above {bound}");
            highest = highest.max(quotient / bound);
            v = (next + v * bound) * (bound * norm(v)).recip();
        }
    }
    // The bound is not far above the highest value.
    assert!(highest > 0.75, "{highest}");
}

#[test]
fn the_stress_is_the_slope_of_the_energy() {
    let stress = DMat3::from_cols_array(&[1e6, 2e6, 0.0, 2e6, -3e6, 5e5, 0.0, 5e5, 4e6]);
    let body = cuboid(1.0, 2.0, 3.0, stress);
    let s = second(DVec3::new(1.0, 2.0, 3.0)) * DENSITY;
    for seed in 0..10 {
        let (f, v) = (DMat3::IDENTITY + noise(seed) * 0.1, noise(seed + 20));
        let h = 1e-5;
        let slope = (body.strain_energy(f + v * h) - body.strain_energy(f - v * h)) / (2.0 * h);
        let force = (body.accelerations(f, &NONE).1 * s).to_cols_array();
        let work: f64 = force
            .iter()
            .zip(v.to_cols_array())
            .map(|(a, b)| a * b)
            .sum();
        // Second order in h, with third derivatives of the size of the first ones.
        assert!(
            (work + slope).abs() < 1e-8 * norm(v) * 6e9,
            "{work}, {slope}"
        );
    }
}
