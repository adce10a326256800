//! A cube that swings in its volume: ω² = 12(3λ + 2μ)/(ρa²), which a central difference shortens by (ωΔt)²/24.

use super::{super::rock::DENSITY, ROCK, alone, step};
use crate::validate::{Outcome, Stand, Trial};
use glam::{DMat3, DVec3};
use std::{f64::consts::TAU, time::Instant};

const PERIODS: usize = 50;

/// The period at three steps, and its order.
pub fn run(_: &Stand) -> Outcome {
    let a = 2.0;
    let [lambda, mu] = ROCK.lame();
    let omega = (12.0 * (3.0 * lambda + 2.0 * mu) / (DENSITY * a * a)).sqrt();
    let mut records = Vec::new();
    for product in [0.2, 0.1, 0.05] {
        let begin = Instant::now();
        let body = alone(DVec3::splat(a));
        let dt = product / omega;
        // So small that the law is linear to the digits that are judged.
        let (mut f, mut rate) = (DMat3::IDENTITY * (1.0 + 1e-8), DMat3::ZERO);
        let mut crossings = Vec::new();
        let mut before = body.strain(f).x_axis.x;
        let mut steps = 0;
        while crossings.len() <= PERIODS {
            step(&body, &mut f, &mut rate, dt);
            steps += 1;
            let now = body.strain(f).x_axis.x;
            if before > 0.0 && now <= 0.0 {
                crossings.push((steps as f64 - now / (now - before)) * dt);
            }
            before = now;
        }
        let period = (crossings[PERIODS] - crossings[0]) / PERIODS as f64;
        let trial = Trial {
            setup: format!("cube of {a} m, ωΔt = {product}, {PERIODS} periods"),
            cells: 1,
            steps,
            seconds: begin.elapsed().as_secs_f64(),
            ..Trial::default()
        };
        // sin(½ω'Δt) = ½ωΔt of the central difference.
        let exact = 2.0 * (0.5 * product).asin() / product;
        records.push(trial.report("period / 2π/ω", period * omega / TAU, Some(1.0)));
        records.push(trial.relative(
            "the same by the step's own ω",
            period * omega / TAU * exact,
            1.0,
            1e-5,
        ));
    }
    Ok(records)
}
