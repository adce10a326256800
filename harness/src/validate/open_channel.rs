//! A plane channel between open faces: the pressure gradient inside.

use super::{CaseContext, Outcome, fields};
use riprap::lattice::{Face, Setup, State};

const LENGTH: u32 = 48;
const HEIGHT: u32 = 11;
const TAU: f64 = 0.9;
/// Speed in the middle: the density falls along the channel by only one part in 300.
const SPEED: f64 = 0.004;
const LIMIT: f64 = 0.01;
/// Twenty times H²/ν, and the time in which the mean pressure settles.
const STEPS: u64 = 20_000;

fn channel(context: &CaseContext, faces: [Face; 2]) -> Setup {
    let mut setup = context.setup([LENGTH, HEIGHT, 4], (TAU - 0.5) / 3.0);
    setup.lambda = Some(3.0 / 16.0);
    setup.faces[0] = faces;
    setup.faces[1] = [Face::Wall([0.0; 3]), Face::Wall([0.0; 3])];
    setup
}

fn parabola() -> Face {
    let h = f64::from(HEIGHT);
    let of = |n: u32| {
        let y = f64::from(n % HEIGHT) + 0.5;
        [(4.0 * SPEED * y * (h - y) / (h * h)) as f32, 0.0, 0.0]
    };
    Face::Velocity((0..4 * HEIGHT).map(of).collect())
}

/// Parabolic inlet; the pressure is held at the outlet.
pub fn velocity_pressure(context: &CaseContext) -> Outcome {
    let outlet = Face::Pressure { density: 1.0 };
    run(context, channel(context, [parabola(), outlet]), Some(SPEED))
}

/// Parabolic inlet; sound and vortices may leave through the outlet.
pub fn velocity_outflow(context: &CaseContext) -> Outcome {
    let outlet = Face::Outflow { density: 1.0 };
    run(context, channel(context, [parabola(), outlet]), Some(SPEED))
}

/// Both pressures are held; the densities differ by 3 Δp.
pub fn pressure_pressure(context: &CaseContext) -> Outcome {
    let half = 1.5 * slope(SPEED) * f64::from(LENGTH);
    let face = |density| Face::Pressure { density };
    let setup = channel(context, [face(1.0 - half), face(1.0 + half)]);
    run(context, setup, None)
}

/// dp/dx of plane Poiseuille flow, −8 ν U/H².
fn slope(speed: f64) -> f64 {
    -8.0 * (TAU - 0.5) / 3.0 * speed / f64::from(HEIGHT * HEIGHT)
}

/// `inlet` is the speed in the middle if it is prescribed; otherwise the pressure gradient is prescribed.
fn run(context: &CaseContext, setup: Setup, inlet: Option<f64>) -> Outcome {
    let cells = setup.cells;
    let rest = State::rest((LENGTH * HEIGHT * 4) as usize);
    let mut flow = context.flow(setup, &rest, false)?;
    flow.advance(STEPS - 1000)?;
    let before = flow.state()?;
    flow.advance(1000)?;
    let end = flow.state()?;
    let trial = flow.trial();
    let middle = |x: u32| (x + LENGTH * (HEIGHT / 2)) as usize;
    let points: Vec<_> = (LENGTH / 4..3 * LENGTH / 4)
        .map(|x| (f64::from(x), f64::from(end.excess[middle(x)]) / 3.0))
        .collect();
    let found = fields::slope(&points);
    let here = f64::from(end.velocity[0][middle(LENGTH / 2)]);
    let mut records = vec![trial.relative(
        "dp/dx against 8μU/H², U found there",
        found,
        slope(here),
        LIMIT,
    )];
    match inlet {
        Some(speed) => {
            let expected = slope(speed);
            records.push(trial.relative("dp/dx against 8μU/H², U given", found, expected, LIMIT));
        }
        None => {
            let expected = slope(SPEED);
            records.push(trial.relative("dp/dx against Δp/L", found, expected, LIMIT));
        }
    }
    let shape = fields::l2_error(cells, &end, |[_, y, _]| {
        let h = f64::from(HEIGHT);
        [4.0 * SPEED * y * (h - y) / (h * h), 0.0, 0.0]
    });
    records.push(trial.report("L2 difference of u from the parabola", shape));
    let last = f64::from(end.excess[middle(LENGTH - 1)]) / 3.0;
    records.push(trial.report(
        "p in the last cell / drop in the channel",
        last / (slope(SPEED) * f64::from(LENGTH)).abs(),
    ));
    let change = fields::largest_change(&before, &end) / SPEED;
    records.push(trial.report("change of u in the last 1000 steps / U", change));
    Ok(records)
}
