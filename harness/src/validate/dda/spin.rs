//! A block that turns at a constant rate: its centrifugal strain is known exactly, and it must not grow. With
//! F = R U and U constant, U Σ = ω² U S/V in the plane of the turn, so that Σ = ω² S/V there.

use super::{super::rock::DENSITY, ROCK, alone, norm, step};
use crate::validate::{Outcome, Stand, Trial};
use glam::{DMat3, DVec3};
use riprap::geometry::skew;
use std::{f64::consts::TAU, time::Instant};

const OMEGA: f64 = 20.0;

/// Strain, angular momentum and energy over a hundred revolutions; with `--full` over a thousand.
pub fn run(stand: &Stand) -> Outcome {
    let begin = Instant::now();
    let body = alone(DVec3::new(1.0, 2.0, 3.0));
    let stress = DVec3::new(0.0, 4.0, 9.0) * (DENSITY / 12.0 * OMEGA * OMEGA);
    let (young, ratio) = (ROCK.youngs_modulus, ROCK.poissons_ratio);
    let exact = (stress * (1.0 + ratio) - DVec3::splat(ratio * stress.element_sum())) / young;
    let stretch = (exact * 2.0 + DVec3::ONE).to_array().map(f64::sqrt);
    let mut f = DMat3::from_diagonal(DVec3::from_array(stretch));
    let mut rate = skew(DVec3::X * OMEGA) * f;
    let start = body.angular_momentum(f, rate);
    let energy = |f, rate| body.kinetic(rate) + body.strain_energy(f);
    let before = energy(f, rate);
    let revolutions = if stand.full { 1000.0 } else { 100.0 };
    let dt = 0.1 * body.critical_step();
    let steps = (revolutions * TAU / OMEGA / dt) as u64;
    let (mut strain, mut momentum, mut gain) = (0.0f64, 0.0f64, 0.0f64);
    for _ in 0..steps {
        step(&body, &mut f, &mut rate, dt);
        let off = body.strain(f) - DMat3::from_diagonal(exact);
        strain = strain.max(norm(off) / exact.max_element());
        let now = body.angular_momentum(f, rate);
        momentum = momentum.max((now - start).length() / start.length());
        gain = gain.max((energy(f, rate) / before - 1.0).abs());
    }
    let trial = Trial {
        setup: format!(
            "1x2x3 m, {OMEGA} rad/s, {revolutions} revolutions, strain {:.1e}",
            exact.z
        ),
        cells: 1,
        steps,
        seconds: begin.elapsed().as_secs_f64(),
        ..Trial::default()
    };
    let second_order = (OMEGA * dt).powi(2);
    Ok(vec![
        trial.at_most("largest error of the strain / strain", strain, second_order),
        trial.at_most("largest error of the momentum / momentum", momentum, 1e-12),
        trial.at_most("largest error of the energy / energy", gain, 1e-10),
        trial.at_most(
            "growth of the volume",
            f.determinant() - DVec3::from_array(stretch).element_product(),
            1e-9,
        ),
    ])
}
