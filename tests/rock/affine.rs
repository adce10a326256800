//! Affine bodies alone: their critical step, their spin, their vibration.

use glam::{DMat3, DVec3};
use riprap::rock::{
    integrate::{Affine, Wrench},
    law::Elastic,
};
use std::f64::consts::TAU;

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

/// A central difference step, as [`riprap::rock::Blocks`] takes it.
fn step(body: &Affine, f: &mut DMat3, rate: &mut DMat3, dt: f64) {
    *rate += body.accelerations(*f, &NONE).1 * (0.5 * dt);
    *f += *rate * dt;
    *rate += body.accelerations(*f, &NONE).1 * (0.5 * dt);
}

fn norm(a: DMat3) -> f64 {
    let columns = [a.x_axis, a.y_axis, a.z_axis];
    columns
        .iter()
        .map(|c| c.length_squared())
        .sum::<f64>()
        .sqrt()
}

/// Numbers between −1 and 1 that look random: fractions of multiples of the golden ratio.
fn noise(seed: u32) -> DMat3 {
    let entry = |k: u32| 2.0 * (f64::from(9 * seed + k + 1) * 0.618_033_988_75).fract() - 1.0;
    DMat3::from_cols_array(&std::array::from_fn(|k| entry(k as u32)))
}

/// Largest eigenvalue of the nine-by-nine problem, by power iteration on M⁻¹K as it stands in textbooks:
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
    let block = cuboid(1.0, 2.0, 3.0, DMat3::ZERO);
    // Three digits are known.
    assert!(
        (block.critical_step() - 8.13e-4).abs() < 0.005e-4,
        "{}",
        block.critical_step()
    );
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
fn the_stiffest_mode_of_a_cube_is_its_volume() {
    let [lambda, mu] = ROCK.lame();
    let a = 0.7;
    let expected = a / (3.0 * (3.0 * lambda + 2.0 * mu) / DENSITY).sqrt();
    let step = cuboid(a, a, a, DMat3::ZERO).critical_step();
    assert!(
        (step / expected - 1.0).abs() < 1e-12,
        "{step} or {expected}"
    );
}

#[test]
fn the_central_difference_is_stable_just_below_the_critical_step_and_not_just_above() {
    for body in [
        cuboid(1.0, 2.0, 3.0, DMat3::ZERO),
        cuboid(1.0, 1.0, 1.0, DMat3::ZERO),
    ] {
        let largest = |share: f64, steps: u32| {
            let (mut f, mut rate) = (DMat3::IDENTITY, DMat3::ZERO);
            // So small that the law is linear, with a share in every mode.
            f += noise(1) * 1e-9;
            let mut most = 0.0f64;
            for _ in 0..steps {
                step(&body, &mut f, &mut rate, share * body.critical_step());
                most = most.max(norm(body.strain(f)));
            }
            most
        };
        let (early, late) = (largest(0.98, 50_000), largest(0.98, 100_000));
        assert!(late < 1.01 * early && late < 2e-8, "{early}, then {late}");
        // ωΔt = 2.04 gains |z| = 1.49 a step: 8e6 in forty.
        let blown = largest(1.02, 40);
        assert!(blown > 1e4 * early, "{blown} after {early}");
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
        // −∂F̈/∂F is symmetric for S: power iteration, shifted so that no negative value is the largest.
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
    // And it is no idle one.
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

/// A block that turns at the constant rate ω about x is stretched to F = R U: V U Σ = ω² U S in the plane of
/// its turn, so that Σ = ω² S/V there and E = ½(U² − 1) follows from Σ by Hooke's law, exactly.
#[test]
fn a_spinning_block_has_the_exact_centrifugal_strain_and_does_not_grow() {
    let body = cuboid(1.0, 2.0, 3.0, DMat3::ZERO);
    let omega = 20.0;
    let s = DVec3::new(1.0, 4.0, 9.0) * (DENSITY / 12.0);
    let stress = DVec3::new(0.0, s.y, s.z) * (omega * omega);
    let (young, ratio) = (ROCK.youngs_modulus, ROCK.poissons_ratio);
    let sum = stress.element_sum();
    let exact = (stress * (1.0 + ratio) - DVec3::splat(ratio * sum)) / young;
    assert!(exact.max_element() > 2e-4, "{exact}");
    let stretch = DVec3::from_array(exact.to_array().map(|e| (1.0 + 2.0 * e).sqrt()));

    let mut f = DMat3::from_diagonal(stretch);
    let mut rate = riprap::geometry::skew(DVec3::X * omega) * f;
    let start = body.angular_momentum(f, rate);
    let energy = |f: DMat3, rate: DMat3| body.kinetic(rate) + body.strain_energy(f);
    let before = energy(f, rate);
    let dt = 0.1 * body.critical_step();
    let revolutions = 100.0;
    let steps = (revolutions * TAU / omega / dt) as u32;
    let (mut worst, mut off, mut gained) = (0.0f64, 0.0f64, 0.0f64);
    for _ in 0..steps {
        step(&body, &mut f, &mut rate, dt);
        let strain = body.strain(f) - DMat3::from_diagonal(exact);
        worst = worst.max(norm(strain) / exact.max_element());
        let momentum = body.angular_momentum(f, rate);
        off = off.max((momentum - start).length() / start.length());
        gained = gained.max((energy(f, rate) / before - 1.0).abs());
    }
    println!("{steps} steps: strain off by {worst:.1e}, momentum {off:.1e}, energy {gained:.1e}");
    // A step of second order changes the strain by (ωΔt)² = 2.6e-6 of it.
    assert!(worst < 2.6e-6, "{worst}");
    assert!(off < 1e-12, "{off}");
    assert!(gained < 1e-12, "{gained}");
}

#[test]
fn the_volume_of_a_cube_swings_with_its_period() {
    let a = 2.0;
    let body = cuboid(a, a, a, DMat3::ZERO);
    let [lambda, mu] = ROCK.lame();
    let omega = (12.0 * (3.0 * lambda + 2.0 * mu) / (DENSITY * a * a)).sqrt();
    // The law is linear up to the amplitude, the central difference short by (ωΔt)²/24 = 1.7e-5.
    let (mut f, mut rate) = (DMat3::IDENTITY * (1.0 + 1e-7), DMat3::ZERO);
    let dt = 0.02 / omega;
    let mut crossings = Vec::new();
    let mut before = body.strain(f).x_axis.x;
    for n in 1.. {
        step(&body, &mut f, &mut rate, dt);
        let now = body.strain(f).x_axis.x;
        if before > 0.0 && now <= 0.0 {
            crossings.push((f64::from(n) - now / (now - before)) * dt);
        }
        before = now;
        if crossings.len() == 51 {
            break;
        }
    }
    let period = (crossings[50] - crossings[0]) / 50.0;
    let error = period * omega / TAU - 1.0;
    println!("period off by {error:.1e}");
    assert!((error + 0.02f64.powi(2) / 24.0).abs() < 1e-6, "{error}");
}
