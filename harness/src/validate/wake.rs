//! Vortices behind a square cylinder cross the outlet.

use super::{Outcome, Stand, fields};
use riprap::lattice::Face;

/// Edge of the cylinder, cells.
const D: u32 = 10;
const SPEED: f64 = 0.1;
const REYNOLDS: f64 = 200.0;
const CELLS: [u32; 3] = [16 * D, 8 * D, 4];
/// From inlet to outlet the fluid takes 1600 steps, a vortex is shed every 560.
const STEPS: u64 = 6_400;
const FULL_STEPS: u64 = 12_800;
const SAMPLE: u64 = 50;

/// The pressure is held where the wake leaves.
pub fn pressure(stand: &Stand) -> Outcome {
    run(stand, Face::Pressure { density: 1.0 })
}

/// Sound and vortices may leave.
pub fn outflow(stand: &Stand) -> Outcome {
    run(stand, Face::Outflow { density: 1.0 })
}

fn run(stand: &Stand, outlet: Face) -> Outcome {
    let [nx, ny, nz] = CELLS;
    let steps = if stand.full { FULL_STEPS } else { STEPS };
    let mut setup = stand.setup(CELLS, SPEED * f64::from(D) / REYNOLDS);
    let inlet = vec![[SPEED as f32, 0.0, 0.0]; (ny * nz) as usize];
    setup.faces[0] = [Face::Velocity(inlet), outlet];
    setup.faces[1] = [Face::FreeSlip, Face::FreeSlip];
    let (low, high) = (4.0 * f64::from(D), 5.0 * f64::from(D));
    let middle = 0.5 * f64::from(ny);
    let half = 0.5 * f64::from(D);
    let in_cylinder = |[x, y, _]: [f64; 3]| (low..high).contains(&x) && (y - middle).abs() < half;
    setup.solid = fields::centres(CELLS).map(in_cylinder).collect();
    // A crosswind behind the cylinder breaks the symmetry, so that vortices come at once.
    let start = fields::state(CELLS, |at| {
        let crosswind = if (high..high + 20.0).contains(&at[0]) {
            0.1 * SPEED
        } else {
            0.0
        };
        let moves = f64::from(u8::from(!in_cylinder(at)));
        (0.0, [moves * SPEED, moves * crosswind, 0.0])
    });
    let mut flow = stand.flow(setup, &start, false)?;

    // Two edges behind the cylinder, on the centre line, and at the outlet.
    let at = |x: u32| (x + nx * (ny / 2)) as usize;
    let (behind, last) = (at(7 * D), at(nx - 1));
    let mut crosswise = Vec::new();
    let (mut fastest, mut swing) = (0.0f64, 0.0f64);
    let mut fault = None;
    while fault.is_none() && flow.trial().steps < steps {
        fault = flow.try_advance(SAMPLE)?;
        let state = flow.state()?;
        if flow.trial().steps > steps / 2 {
            crosswise.push(f64::from(state.velocity[1][behind]));
            swing = swing.max(f64::from(state.excess[last]).abs() / 3.0);
            let speeds = state.velocity[0].iter().zip(&state.velocity[1]);
            let squares = speeds.map(|(u, v)| f64::from(u * u + v * v));
            fastest = fastest.max(squares.fold(0.0, f64::max).sqrt());
        }
    }
    let survived = fault.map_or(steps, |fault| fault.step);
    let trial = flow.trial();
    let mut records = vec![trial.at_least("steps without a fault", survived as f64, steps as f64)];
    if fault.is_none() {
        records.extend([
            trial.report("largest speed / U, second half", fastest / SPEED),
            trial.report(
                "largest |p| at the outlet / (ρU²/2)",
                swing / (0.5 * SPEED * SPEED),
            ),
            trial.report("Strouhal number f D/U", strouhal(&crosswise)),
        ]);
    }
    Ok(records)
}

/// From the first to the last upward zero crossing of the velocity across.
fn strouhal(samples: &[f64]) -> f64 {
    let mean = samples.iter().sum::<f64>() / samples.len() as f64;
    let crossings: Vec<f64> = samples
        .windows(2)
        .enumerate()
        .filter(|(_, pair)| pair[0] < mean && pair[1] >= mean)
        .map(|(n, pair)| n as f64 + (mean - pair[0]) / (pair[1] - pair[0]))
        .collect();
    match (crossings.first(), crossings.last()) {
        (Some(first), Some(last)) if last > first => {
            let period = (last - first) / (crossings.len() - 1) as f64 * SAMPLE as f64;
            f64::from(D) / SPEED / period
        }
        _ => 0.0,
    }
}
