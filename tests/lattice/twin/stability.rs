//! Linear stability of a uniform stream (von Neumann analysis): growth of plane waves per step.

use kit::twin::{
    Config, OddClass, Rates,
    collide::collide,
    equilibrium::equilibrium,
    lattice::{C, Q},
};

/// A complex matrix by rows: real parts and imaginary parts.
type Matrix = [Vec<f64>; 2];

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let mut out = [vec![0.0; Q * Q], vec![0.0; Q * Q]];
    for i in 0..Q {
        for k in 0..Q {
            let (re, im) = (a[0][i * Q + k], a[1][i * Q + k]);
            for j in 0..Q {
                out[0][i * Q + j] += re * b[0][k * Q + j] - im * b[1][k * Q + j];
                out[1][i * Q + j] += re * b[1][k * Q + j] + im * b[0][k * Q + j];
            }
        }
    }
    out
}

fn norm(a: &Matrix) -> f64 {
    a.iter().flatten().map(|x| x * x).sum::<f64>().sqrt()
}

/// Derivatives of the populations after a collision by those before, at a stream `u`.
fn jacobian(config: &Config, u: [f64; 3]) -> Vec<f64> {
    let rest = equilibrium(config.equilibrium, 1.0, u);
    let mut out = vec![0.0; Q * Q];
    let step = 1e-6;
    for j in 0..Q {
        let [more, less] = [step, -step].map(|change| {
            let mut f = rest;
            f[j] += change;
            collide(config, &f, [0.0; 3], 0.0, OddClass::Bulk)
        });
        for i in 0..Q {
            out[i * Q + j] = (more[i] - less[i]) / (2.0 * step);
        }
    }
    out
}

/// Largest growth per step, over waves of 2 to 8 cells along each axis, from the norms after 4096 and 8192 steps.
fn growth(config: &Config, u: [f64; 3]) -> f64 {
    let collision = jacobian(config, u);
    let waves = (0..125).map(|n| [n % 5, n / 5 % 5, n / 25].map(|part| 0.25 * f64::from(part)));
    let growths = waves.map(|k| {
        let mut step = [vec![0.0; Q * Q], vec![0.0; Q * Q]];
        for i in 0..Q {
            let along: f64 = (0..3).map(|a| k[a] * f64::from(C[i][a])).sum();
            let (sin, cos) = (-std::f64::consts::PI * along).sin_cos();
            for j in 0..Q {
                step[0][i * Q + j] = cos * collision[i * Q + j];
                step[1][i * Q + j] = sin * collision[i * Q + j];
            }
        }
        for _ in 0..12 {
            step = product(&step, &step);
        }
        (norm(&product(&step, &step)) / norm(&step)).ln() / 4096.0
    });
    growths.fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn low_viscosity_rates_grow_slower_than_the_published_ones() {
    let at = |nu: f64, rates| Config {
        rates,
        ..Config::new(0.5 + 3.0 * nu)
    };
    let stream = [0.1, 0.0, 0.0];
    let published = Some(Rates::SUGA);
    assert!(growth(&at(1e-5, published), stream) > 3e-3);
    assert!(growth(&at(1e-5, None), stream) < 1e-3);
    // Eddy viscosities of 1e-4 and 3e-4 damp all waves at 0.05 and 0.1 cells per step.
    assert!(growth(&at(1e-4, published), [0.05, 0.0, 0.0]) > 1e-4);
    assert!(growth(&at(1e-4, None), [0.05, 0.0, 0.0]) < 1e-6);
    assert!(growth(&at(3e-4, published), stream) > 1e-3);
    assert!(growth(&at(3e-4, None), stream) < 1e-6);
}
