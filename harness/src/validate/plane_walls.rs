//! Flows between plane walls: with Λ = 3/16 half-way bounce-back is exact at every τ.

use super::{CaseContext, Method, Outcome, Trial, fields};
use riprap::lattice::{Face, Force, Setup, State};

/// Ginzburg & d'Humières 2003: the parabola is exact, and the straight line at any Λ.
const LAMBDA: f64 = 3.0 / 16.0;
const TAUS: [f64; 6] = [0.55, 0.6, 0.8, 1.0, 2.0, 3.0];
/// Largest velocity: the error of the weak compressibility grows with its square.
const SPEED: f64 = 0.01;
/// Round-off of f32 in a steady state.
const LIMIT: f64 = 1e-5;
const REST: [f64; 3] = [0.0; 3];
/// Times H²/ν to the steady state: the slowest mode falls as exp(−π² ν t/H²) between walls and as
/// exp(−(π/2)² ν t/H²) below a slip top, to 1e-8 of the start.
const BETWEEN_WALLS: f64 = 2.0;
const BELOW_A_SLIP_TOP: f64 = 7.5;

/// Couette flow: straight, u = U y/H.
pub fn couette(context: &CaseContext) -> Outcome {
    each_tau(context, 9, BETWEEN_WALLS, |setup| {
        setup.faces[1] = [Face::Wall(REST), Face::Wall([SPEED, 0.0, 0.0])];
        |y, h| SPEED * y / h
    })
}

/// Poiseuille flow driven by a force: u = F y (H − y)/(2ν).
pub fn poiseuille(context: &CaseContext) -> Outcome {
    each_tau(context, 9, BETWEEN_WALLS, between_walls)
}

/// Poiseuille flow on `height` cells at one τ: the trial, and the L2 error of the velocity.
pub fn poiseuille_on(
    context: &CaseContext,
    height: u32,
    tau: f64,
    method: Method,
) -> anyhow::Result<(Trial, f64)> {
    let mut setup = context.setup([4, height, 4], (tau - 0.5) / 3.0);
    method.arrange(&mut setup);
    let Steady { trial, error, .. } = steady(context, setup, BETWEEN_WALLS, &between_walls)?;
    Ok((trial, error))
}

fn between_walls(setup: &mut Setup) -> impl Fn(f64, f64) -> f64 + use<> {
    let height = f64::from(setup.cells[1]);
    setup.faces[1] = [Face::Wall(REST), Face::Wall(REST)];
    setup.force = Force::Constant([8.0 * setup.nu * SPEED / (height * height), 0.0, 0.0]);
    |y, h| 4.0 * SPEED * y * (h - y) / (h * h)
}

/// A film with a slip top: u = F (H y − y²/2)/ν.
pub fn film(context: &CaseContext) -> Outcome {
    each_tau(context, 8, BELOW_A_SLIP_TOP, |setup| {
        setup.faces[1] = [Face::Wall(REST), Face::FreeSlip];
        setup.force = Force::Constant([2.0 * setup.nu * SPEED / 64.0, 0.0, 0.0]);
        |y, h| SPEED * (2.0 * h * y - y * y) / (h * h)
    })
}

/// Runs the flow that `arrange` sets up at each τ to its steady state.
fn each_tau<Exact: Fn(f64, f64) -> f64>(
    context: &CaseContext,
    height: u32,
    settle: f64,
    arrange: impl Fn(&mut Setup) -> Exact,
) -> Outcome {
    let mut records = Vec::new();
    for tau in TAUS {
        let mut setup = context.setup([4, height, 4], (tau - 0.5) / 3.0);
        setup.lambda = Some(LAMBDA);
        let Steady { trial, error, end } = steady(context, setup, settle, &arrange)?;
        records.push(trial.at_most(format!("L2 error of u, τ = {tau}"), error, LIMIT));
        let profile: Vec<_> = (0..3).map(|y| f64::from(end.velocity[0][4 * y])).collect();
        let quantity = format!("wall at y, cells, τ = {tau}");
        records.push(trial.report(quantity, root(&profile)));
    }
    Ok(records)
}

/// A steady flow.
struct Steady {
    trial: Trial,
    /// L2 error of the velocity.
    error: f64,
    end: State,
}

/// Runs the flow that `arrange` sets up to its steady state.
fn steady<Exact: Fn(f64, f64) -> f64>(
    context: &CaseContext,
    mut setup: Setup,
    settle: f64,
    arrange: &impl Fn(&mut Setup) -> Exact,
) -> anyhow::Result<Steady> {
    let exact = arrange(&mut setup);
    let cells = setup.cells;
    let h = f64::from(cells[1]);
    // At high viscosity sound takes longer than diffusion to calm down.
    let steps = (settle * h * h / setup.nu).ceil().max(1000.0);
    let mut flow = context.flow(setup, &State::rest(16 * cells[1] as usize), false)?;
    flow.advance(steps as u64)?;
    let end = flow.state()?;
    Ok(Steady {
        error: fields::l2_error(cells, &end, |[_, y, _]| [exact(y, h), 0.0, 0.0]),
        trial: flow.trial(),
        end,
    })
}

/// Where the parabola through u(½), u(1½), u(2½) is zero, next to y = 0.
fn root(u: &[f64]) -> f64 {
    let curvature = u[0] - 2.0 * u[1] + u[2];
    let first = u[1] - u[0];
    let value = |y: f64| u[0] + first * (y - 0.5) + 0.5 * curvature * (y - 0.5) * (y - 1.5);
    let derivative = |y: f64| first + curvature * (y - 1.0);
    // Newton's method; the parabola is nearly straight there.
    (0..20).fold(0.0, |y, _| y - value(y) / derivative(y))
}
