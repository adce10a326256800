//! Eddy viscosity of WALE (Nicoud & Ducros 1999) on velocity fields with a known answer, and in a turbulent channel.

use super::{CaseContext, Flow, Outcome, cavity, fields};
use riprap::lattice::{Derived, Face, Force, State};
use std::f64::consts::TAU;

const CONSTANT: f64 = 0.5;
const WALLS: [Face; 2] = [Face::Wall([0.0; 3]), Face::Wall([0.0; 3])];

fn prescribed<'a>(
    context: &'a CaseContext,
    cells: [u32; 3],
    walls: [bool; 3],
    state: &State,
) -> anyhow::Result<(Flow<'a>, Vec<f64>)> {
    let mut setup = context.setup(cells, 0.01);
    setup.wale = Some(CONSTANT);
    for axis in (0..3).filter(|&axis| walls[axis]) {
        setup.faces[axis] = WALLS;
    }
    let mut flow = context.flow(setup, state, false)?;
    let nu_t = flow.derived(Derived::EddyViscosity)?;
    Ok((flow, nu_t.into_iter().map(f64::from).collect()))
}

/// u = γy has no eddy viscosity.
pub fn pure_shear(context: &CaseContext) -> Outcome {
    let cells = [8, 32, 8];
    let gamma = 2e-3;
    let state = fields::state(cells, |[_, y, _]| (0.0, [gamma * y, 0.0, 0.0]));
    let (flow, nu_t) = prescribed(context, cells, [false, true, false], &state)?;
    let largest = nu_t.iter().fold(0.0, |a: f64, b| a.max(*b));
    // The gradient's round-off δ ~ 1e-8 enters as (δ/γ)³: far below f32's resolution of a sum.
    Ok(vec![flow.trial().at_most(
        "largest ν_t / (C_w² γ)",
        largest / (CONSTANT * CONSTANT * gamma),
        1e-12,
    )])
}

/// u = γy (1 + α sin kz), w = βγy sin kx meets a wall without slip: ν_t grows as y³ there.
pub fn near_wall(context: &CaseContext) -> Outcome {
    let n = 128;
    let cells = [n, 16, n];
    let (gamma, alpha, beta) = (4e-3, 0.5, 0.5);
    let k = TAU / f64::from(n);
    let state = fields::state(cells, |[x, y, z]| {
        let u = gamma * y * (1.0 + alpha * (k * z).sin());
        (0.0, [u, 0.0, beta * gamma * y * (k * x).sin()])
    });
    let (flow, nu_t) = prescribed(context, cells, [false, true, false], &state)?;
    // The mean over each of the four layers next to the wall, (ky)² ≤ 0.03.
    let plane = |y: usize| {
        let rows = (0..n as usize).map(|z| n as usize * (y + 16 * z));
        let total: f64 = rows.flat_map(|row| &nu_t[row..row + n as usize]).sum();
        total / f64::from(n * n)
    };
    let layers: Vec<_> = (0..4).map(|y| (y as f64 + 0.5, plane(y))).collect();
    let logs: Vec<_> = layers.iter().map(|(y, nu)| (y.ln(), nu.ln())).collect();
    let exact = |y: f64| mean_near_wall(y, k, [gamma, alpha, beta]);
    let worst = layers
        .iter()
        .map(|&(y, nu)| (nu / exact(y) - 1.0).abs())
        .fold(0.0, f64::max);
    let trial = flow.trial();
    Ok(vec![
        // The terms of the next order, (ky)², bend the power law by 0.02.
        trial.absolute("exponent of ν_t over y", fields::slope(&logs), 3.0, 0.05),
        // Gradients of f32 velocities, u·6e-8 of γ·k·y, cubed.
        trial.at_most("largest error of the mean ν_t(y)", worst, 1e-2),
    ])
}

/// Mean over x and z of the eddy viscosity of the field of [`near_wall`], from its formula in f64; sin k replaces k, as in
/// central differences.
fn mean_near_wall(y: f64, k: f64, [gamma, alpha, beta]: [f64; 3]) -> f64 {
    let n = 128;
    let mut total = 0.0;
    for i in 0..n * n {
        let (x, z) = (k * (f64::from(i % n) + 0.5), k * (f64::from(i / n) + 0.5));
        let (u_y, u_z) = (
            gamma * (1.0 + alpha * z.sin()),
            gamma * y * alpha * k.sin() * z.cos(),
        );
        let (w_x, w_y) = (beta * gamma * y * k.sin() * x.cos(), beta * gamma * x.sin());
        let s = 0.5 * (u_y * u_y + w_y * w_y + (u_z + w_x).powi(2));
        // g² has u_z w_x at xx and zz, u_z w_y at xy, w_x u_y at zy.
        let diagonal = (2.0 / 3.0) * (u_z * w_x).powi(2);
        let d = diagonal + 0.5 * ((u_z * w_y).powi(2) + (w_x * u_y).powi(2));
        total += CONSTANT * CONSTANT * d.powf(1.5) / (s.powf(2.5) + d.powf(1.25));
    }
    total / f64::from(n * n)
}

/// Solid rotation: S = 0, ν_t = C_w² (2/3)^¼ Ω, 0.226 Ω at C_w = 0.5.
pub fn solid_rotation(context: &CaseContext) -> Outcome {
    let cells = [24, 24, 4];
    let spin = 2e-3;
    let state = fields::state(cells, |[x, y, _]| {
        (0.0, [-spin * (y - 12.0), spin * (x - 12.0), 0.0])
    });
    let (flow, nu_t) = prescribed(context, cells, [true, true, false], &state)?;
    let mean = nu_t.iter().sum::<f64>() / nu_t.len() as f64;
    let worst = nu_t.iter().map(|nu| (nu / mean - 1.0).abs());
    let trial = flow.trial();
    Ok(vec![
        trial.relative(
            "ν_t / Ω",
            mean / spin,
            CONSTANT * CONSTANT * (2.0f64 / 3.0).powf(0.25),
            1e-4,
        ),
        trial.at_most(
            "largest deviation of a cell",
            worst.fold(0.0, f64::max),
            1e-3,
        ),
    ])
}

/// A Taylor-Green vortex that decays at ν = 1e-5 on 32³ cells, ten turnovers of u = 0.05: the eddy viscosity evaluated every
/// second step against every step.
pub fn interval(context: &CaseContext) -> Outcome {
    let (cells, speed, nu) = ([32; 3], 0.05, 1e-5);
    let k = TAU / 32.0;
    let start = fields::state(cells, |[x, y, z]| {
        let [x, y, z] = [x, y, z].map(|a| k * a);
        let across = speed * z.cos();
        (
            0.0,
            [across * x.sin() * y.cos(), -across * x.cos() * y.sin(), 0.0],
        )
    });
    let end = |wale_interval: u32| {
        let mut setup = context.setup(cells, nu);
        (setup.wale, setup.wale_interval) = (Some(CONSTANT), wale_interval);
        let mut flow = context.flow(setup, &start, true)?;
        flow.advance((10.0 / (k * speed)) as u64)?;
        let state = flow.state()?;
        anyhow::Ok((flow.trial(), state))
    };
    let ((_, every), (trial, second)) = (end(1)?, end(2)?);
    let energy = |state: &State| -> f64 {
        let squares = state
            .velocity
            .iter()
            .flatten()
            .map(|u| f64::from(*u).powi(2));
        squares.sum()
    };
    let lost = |state: &State| energy(&start) - energy(state);
    let pairs = every
        .velocity
        .iter()
        .flatten()
        .zip(second.velocity.iter().flatten());
    let difference: f64 = pairs.map(|(a, b)| f64::from(a - b).powi(2)).sum();
    Ok(vec![
        trial.report(
            "fraction of the energy lost",
            lost(&second) / energy(&start),
        ),
        trial.relative(
            "energy lost / every step",
            lost(&second) / lost(&every),
            1.0,
            5e-3,
        ),
        trial.at_most(
            "RMS difference of the velocity / RMS velocity",
            (difference / energy(&every)).sqrt(),
            1e-2,
        ),
    ])
}

/// Half height, cells: 4.5 wall units per cell, the first centre at y⁺ = 2.2.
const H: u32 = 40;
/// Streamwise, between the walls, spanwise: long enough for the streaks, 6h × 2h × 3h.
const CHANNEL: [u32; 3] = [6 * H, 2 * H, 3 * H];
/// Friction velocity: the centre line moves at 0.1.
const FRICTION: f64 = 0.0055;
const REYNOLDS: f64 = 178.12;
/// Times h/u_τ until the flow no longer depends on its start, and over which the mean is taken.
const SETTLE: f64 = 15.0;
const AVERAGE: f64 = 20.0;
const SAMPLES: u32 = 200;
/// Limit on the relative error of the mean velocity at y⁺ > 10.
const LIMIT: f64 = 0.05;

/// Turbulent channel at Re_τ = 180 against Moser, Kim & Mansour 1999, on a GPU only: it takes 6·10¹¹ cell updates.
pub fn turbulent_channel(context: &CaseContext) -> Outcome {
    if context.software {
        println!("     left out, it needs a GPU: 6·10¹¹ cell updates");
        return Ok(Vec::new());
    }
    let h = f64::from(H);
    let nu = FRICTION * h / REYNOLDS;
    let mut setup = context.setup(CHANNEL, nu);
    setup.faces[1] = WALLS;
    setup.force = Force::Constant([FRICTION * FRICTION / h, 0.0, 0.0]);
    setup.wale = Some(CONSTANT);
    let mut flow = context.flow(
        setup,
        &fields::turbulent_channel(CHANNEL, h, FRICTION, REYNOLDS),
        true,
    )?;
    let turn = h / FRICTION;
    flow.advance((SETTLE * turn) as u64)?;
    let mut profile = vec![0.0; 2 * H as usize];
    for _ in 0..SAMPLES {
        flow.advance((AVERAGE * turn / f64::from(SAMPLES)) as u64)?;
        add_profile(&mut profile, &flow.state()?);
    }
    // Both halves are statistically the same.
    let mean = |y: usize| (profile[y] + profile[2 * H as usize - 1 - y]) / 2.0 / FRICTION;
    let tables = cavity::literature()?;
    let heights = cavity::list(&tables, ["mkm_1999_Retau180", "y_over_delta"])?;
    let speeds = cavity::list(&tables, ["mkm_1999_Retau180", "Umean_plus"])?;
    let trial = flow.trial();
    let mut worst = (0.0f64, 0.0);
    let mut records = Vec::new();
    for y in 0..H as usize {
        let height = (y as f64 + 0.5) / h;
        let expected = fields::cubic(&heights, &speeds, height);
        let wall_units = height * REYNOLDS;
        if wall_units > 10.0 {
            let error = (mean(y) / expected - 1.0).abs();
            if error >= worst.0 {
                worst = (error, wall_units);
            }
        }
        if [2, 7, H as usize - 1].contains(&y) {
            let quantity = format!("U⁺ at y⁺ = {wall_units:.1}");
            records.push(trial.relative(quantity, mean(y), expected, None));
        }
    }
    let quantity = format!("largest error of U⁺, y⁺ > 10 (at {:.0})", worst.1);
    records.push(trial.at_most(quantity, worst.0, LIMIT));
    Ok(records)
}

/// Adds the mean of u over each plane between the walls, as one of [`SAMPLES`].
fn add_profile(profile: &mut [f64], state: &State) {
    let share = 1.0 / f64::from(CHANNEL[0] * CHANNEL[2] * SAMPLES);
    for (n, &u) in state.velocity[0].iter().enumerate() {
        let y = (n / CHANNEL[0] as usize) % CHANNEL[1] as usize;
        profile[y] += share * f64::from(u);
    }
}
