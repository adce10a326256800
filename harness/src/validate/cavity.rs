//! Lid-driven cavity against the tables of Ghia, Ghia & Shin 1982.

use super::{CaseContext, Method, Outcome, Trial, fields};
use anyhow::Context;
use riprap::lattice::{Face, State};
use serde_json::Value;

/// Speed of the lid: the error of the weak compressibility grows with its square.
const SPEED: f64 = 0.1;
/// Largest change of the velocity in a time L/U, in units of U, that counts as steady.
const STEADY: f64 = 1e-5;
/// Times L/U without a smaller change after which a run ends: the rest is rounding, or the flow does not become steady.
const STALLED: u64 = 10;
/// Times L/U after which a run ends even if the cavity is not steady.
const LONGEST: u64 = 150;

/// The published tables that several cases compare with.
pub fn literature() -> anyhow::Result<Value> {
    let text = include_str!("../../kit/data/literature_tables.json");
    serde_json::from_str(text).context("the table of published values")
}

/// A list of numbers from the tables.
pub fn list(table: &Value, names: [&str; 2]) -> anyhow::Result<Vec<f64>> {
    let values = table[names[0]][names[1]].as_array();
    let values = values.with_context(|| format!("no published list {names:?}"))?;
    Ok(values.iter().filter_map(Value::as_f64).collect())
}

/// Re = 100 on 64 cells; with `--full` also on 128.
pub fn re100(context: &CaseContext) -> Outcome {
    let sizes: &[u32] = if context.full { &[64, 128] } else { &[64] };
    run(context, sizes, 100.0, "Re100", 0.005)
}

/// Re = 1000 on 64 cells for comparison and on 128.
pub fn re1000(context: &CaseContext) -> Outcome {
    run(context, &[64, 128], 1000.0, "Re1000", 0.01)
}

/// `limit` bounds the rms error on the centre lines over U on the finest grid.
fn run(context: &CaseContext, sizes: &[u32], reynolds: f64, column: &str, limit: f64) -> Outcome {
    let mut records = Vec::new();
    for &n in sizes {
        let found = measure(context, n, (reynolds, column), Method::DEFAULT)?;
        let (trial, [of_u, of_v, of_both]) = (found.trial, found.errors);
        for (name, error) in [("u", of_u), ("v", of_v)] {
            let quantity = format!("rms error of {name} / U, {n} cells");
            records.push(trial.report(quantity, error));
        }
        let quantity = format!("rms error of u and v / U, {n} cells");
        let judged = (Some(&n) == sizes.last()).then_some(limit);
        records.push(trial.at_most(quantity, of_both, judged));
        records.push(trial.report("change in the last L/U / U", found.change));
    }
    Ok(records)
}

fn viscosity(n: u32, reynolds: f64) -> f64 {
    SPEED * f64::from(n) / reynolds
}

/// Relaxation time on `n` cells.
pub fn tau(n: u32, reynolds: f64) -> f64 {
    0.5 + 3.0 * viscosity(n, reynolds)
}

/// Results on one grid.
pub struct Cavity {
    /// Setup and cost of the run.
    pub trial: Trial,
    /// Errors of u, of v and of both on the centre lines, r.m.s., in units of U.
    pub errors: [f64; 3],
    /// Largest change of the velocity in the last time L/U, in units of U.
    pub change: f64,
}

/// Runs the cavity on `n` cells along each edge; `column` names the published values for the Reynolds number.
pub fn measure(
    context: &CaseContext,
    n: u32,
    (reynolds, column): (f64, &str),
    method: Method,
) -> anyhow::Result<Cavity> {
    let tables = literature()?;
    let u_at = list(&tables, ["ghia_1982_u_x0.5", "y"])?;
    let u = list(&tables, ["ghia_1982_u_x0.5", column])?;
    let v_at = list(&tables, ["ghia_1982_v_y0.5", "x"])?;
    let v = list(&tables, ["ghia_1982_v_y0.5", column])?;
    let mut setup = context.setup([n, n, 4], viscosity(n, reynolds));
    setup.faces[0] = [Face::Wall([0.0; 3]), Face::Wall([0.0; 3])];
    setup.faces[1] = [Face::Wall([0.0; 3]), Face::Wall([SPEED, 0.0, 0.0])];
    method.arrange(&mut setup);
    let turn = (f64::from(n) / SPEED).round() as u64;
    let mut before = State::rest((4 * n * n) as usize);
    let mut flow = context.flow(setup, &before, false)?;
    let mut change = f64::INFINITY;
    let (mut least, mut since) = (f64::INFINITY, 0);
    while change > STEADY && since < STALLED && flow.trial().steps < LONGEST * turn {
        flow.advance(turn)?;
        let state = flow.state()?;
        change = fields::largest_change(&before, &state) / SPEED;
        since = if change < least { 0 } else { since + 1 };
        least = least.min(change);
        before = state;
    }
    let at = |x: u32, y: u32| (x + n * y) as usize;
    let middle = [n / 2 - 1, n / 2];
    let mean = |values: [f32; 2]| 0.5 * f64::from(values[0] + values[1]) / SPEED;
    let u_line = line(n, [0.0, 1.0], |y| {
        mean(middle.map(|x| before.velocity[0][at(x, y)]))
    });
    let v_line = line(n, [0.0, 0.0], |x| {
        mean(middle.map(|y| before.velocity[1][at(x, y)]))
    });
    let (of_u, of_v) = (errors(&u_line, &u_at, &u), errors(&v_line, &v_at, &v));
    Ok(Cavity {
        trial: flow.trial(),
        errors: [rms(&of_u), rms(&of_v), rms(&[of_u, of_v].concat())],
        change,
    })
}

/// Places and values on a centre line, walls included.
fn line(n: u32, walls: [f64; 2], value: impl Fn(u32) -> f64) -> (Vec<f64>, Vec<f64>) {
    let inside = (0..n).map(|k| ((f64::from(k) + 0.5) / f64::from(n), value(k)));
    std::iter::once((0.0, walls[0]))
        .chain(inside)
        .chain(std::iter::once((1.0, walls[1])))
        .unzip()
}

/// Differences from the table between the walls; on the walls both have the boundary value.
fn errors(line: &(Vec<f64>, Vec<f64>), places: &[f64], values: &[f64]) -> Vec<f64> {
    let inside = places
        .iter()
        .zip(values)
        .filter(|(x, _)| **x > 0.0 && **x < 1.0);
    inside
        .map(|(&x, value)| fields::cubic(&line.0, &line.1, x) - value)
        .collect()
}

fn rms(errors: &[f64]) -> f64 {
    (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt()
}
