//! Δt_c = 2/ω_max of the nine-by-nine elastic problem, and that the central difference is stable just below it
//! and not just above.

use super::{super::rock::DENSITY, ROCK, alone, norm, step};
use crate::validate::{Outcome, Stand, Trial};
use glam::{DMat3, DVec3};
use std::time::Instant;

/// Largest strain within `steps` of `share` of the critical step, from one of 1e-9 in every mode.
fn largest(edges: DVec3, share: f64, steps: u64) -> (f64, Trial) {
    let begin = Instant::now();
    let body = alone(edges);
    // No two entries alike, so that every mode has a share.
    let start = [1.0, 0.3, -0.7, 0.2, -0.9, 0.5, -0.4, 0.6, 0.8];
    let mut f = DMat3::IDENTITY + DMat3::from_cols_array(&start) * 1e-9;
    let (mut rate, mut most) = (DMat3::ZERO, 0.0f64);
    for _ in 0..steps {
        step(&body, &mut f, &mut rate, share * body.critical_step());
        most = most.max(norm(body.strain(f)));
    }
    let [x, y, z] = edges.to_array();
    let trial = Trial {
        setup: format!("{x}x{y}x{z} m, {share} Δt_c"),
        cells: 1,
        steps,
        seconds: begin.elapsed().as_secs_f64(),
        ..Trial::default()
    };
    (most, trial)
}

/// The step of a block and of a cube, and what a step next to it does.
pub fn run(_: &Stand) -> Outcome {
    let trial = Trial {
        setup: "E = 1 GPa, ν = 0.25, ρ = 2500 kg/m³".into(),
        cells: 1,
        ..Trial::default()
    };
    let (block, cube) = (DVec3::new(1.0, 2.0, 3.0), DVec3::ONE);
    let [lambda, mu] = ROCK.lame();
    let volumetric = (3.0 * (3.0 * lambda + 2.0 * mu) / DENSITY).sqrt().recip();
    let mut records = vec![
        // Three digits of the reference are known.
        trial.absolute(
            "Δt_c of 1x2x3 m, s",
            alone(block).critical_step(),
            8.13e-4,
            5e-7,
        ),
        // The two take different ways to the same number.
        trial.relative(
            "Δt_c of 1 m, s",
            alone(cube).critical_step(),
            volumetric,
            1e-12,
        ),
    ];
    for edges in [block, cube] {
        let (early, _) = largest(edges, 0.98, 50_000);
        let (late, trial) = largest(edges, 0.98, 100_000);
        records.push(trial.absolute("strain over 1e5 steps / over 5e4", late / early, 1.0, 0.01));
        let (blown, trial) = largest(edges, 1.02, 40);
        // It gains the factor 1.49 a step.
        records.push(trial.at_least("strain over 40 steps / at 0.98", blown / early, 1e4));
    }
    Ok(records)
}
