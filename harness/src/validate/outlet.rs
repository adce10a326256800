//! Outlets: reflection of a pulse of sound, and vortices behind a square cylinder that cross them.

use super::{CaseContext, Outcome, Trial, fields};
use riprap::lattice::Face;

/// Length of the channel of the pulse, cells.
const LENGTH: u32 = 200;
/// Amplitude of the pulse in density.
const PULSE: f64 = 1e-3;
/// Standard deviation of the pulse, cells: a tenth of the domain from flank to flank.
const WIDTH: f64 = 8.0;
/// Steps of a run: the pulse starts in the middle, and its reflection would have travelled back a third of the channel.
const PULSE_STEPS: u64 = 300;
/// Limit on the returned amplitude over that of the pulse.
const RETURNED: f64 = 0.02;

/// Reflection of sound by an outlet: a pulse of density 1e-3 runs into the outlet, in fluid at rest and in a stream.
pub fn pulse(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    for speed in [0.0, 0.05, 0.1] {
        let outlet = Face::Outflow { density: 1.0 };
        let (trial, returned) = send(context, speed, outlet)?;
        let quantity = format!("outflow: returned amplitude, U = {speed}");
        records.push(trial.at_most(quantity, returned, RETURNED));
    }
    let (trial, returned) = send(context, 0.0, Face::Pressure { density: 1.0 })?;
    let quantity = "pressure: returned amplitude, U = 0";
    records.push(trial.report(quantity, returned));
    Ok(records)
}

fn send(context: &CaseContext, speed: f64, outlet: Face) -> anyhow::Result<(Trial, f64)> {
    let cells = [LENGTH, 4, 4];
    let mut setup = context.setup(cells, 1e-3);
    setup.faces[0] = [Face::Velocity(vec![[speed as f32, 0.0, 0.0]; 16]), outlet];
    let start = fields::state(cells, |[x, _, _]| {
        let distance = (x - 0.5 * f64::from(LENGTH)) / WIDTH;
        let excess = PULSE * (-0.5 * distance * distance).exp();
        // A wave that travels only towards +x: u' = c_s ρ'/ρ.
        let sound = excess / (3f64.sqrt() * (1.0 + excess));
        (excess, [speed + sound, 0.0, 0.0])
    });
    let mut flow = context.flow(setup, &start, true)?;
    flow.advance(PULSE_STEPS)?;
    let largest = flow
        .state()?
        .excess
        .iter()
        .fold(0f32, |a, b| a.max(b.abs()));
    Ok((flow.trial(), f64::from(largest) / PULSE))
}

/// Edge of the cylinder, cells.
const D: u32 = 10;
const SPEED: f64 = 0.1;
const REYNOLDS: f64 = 200.0;
const CELLS: [u32; 3] = [16 * D, 8 * D, 4];
/// The fluid takes 1600 steps from inlet to outlet; a vortex is shed every 560.
const STEPS: u64 = 6_400;
const FULL_STEPS: u64 = 12_800;
const SAMPLE: u64 = 50;

/// Vortices behind a square cylinder leave through a face of held pressure.
pub fn wake_pressure(context: &CaseContext) -> Outcome {
    run(context, Face::Pressure { density: 1.0 })
}

/// Vortices behind a square cylinder leave through an outlet that lets sound and vortices leave.
pub fn wake_outflow(context: &CaseContext) -> Outcome {
    run(context, Face::Outflow { density: 1.0 })
}

fn run(context: &CaseContext, outlet: Face) -> Outcome {
    let [nx, ny, nz] = CELLS;
    let steps = if context.full { FULL_STEPS } else { STEPS };
    let mut setup = context.setup(CELLS, SPEED * f64::from(D) / REYNOLDS);
    let inlet = vec![[SPEED as f32, 0.0, 0.0]; (ny * nz) as usize];
    setup.faces[0] = [Face::Velocity(inlet), outlet];
    setup.faces[1] = [Face::FreeSlip, Face::FreeSlip];
    let (low, high) = (4.0 * f64::from(D), 5.0 * f64::from(D));
    let middle = 0.5 * f64::from(ny);
    let half = 0.5 * f64::from(D);
    let in_cylinder = |[x, y, _]: [f64; 3]| (low..high).contains(&x) && (y - middle).abs() < half;
    setup.solid = fields::centres(CELLS).map(in_cylinder).collect();
    // A crosswind behind the cylinder breaks the symmetry, so that vortices form at once.
    let start = fields::state(CELLS, |at| {
        let crosswind = if (high..high + 20.0).contains(&at[0]) {
            0.1 * SPEED
        } else {
            0.0
        };
        let moves = f64::from(u8::from(!in_cylinder(at)));
        (0.0, [moves * SPEED, moves * crosswind, 0.0])
    });
    let mut flow = context.flow(setup, &start, false)?;

    // Two edge lengths behind the cylinder, on the centre line, and at the outlet.
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

/// Strouhal number from the first and the last upward crossing of the mean of the cross-stream velocity.
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
