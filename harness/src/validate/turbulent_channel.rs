//! Turbulent channel at Re_τ = 180 against Moser, Kim & Mansour 1999.

use super::{Outcome, Stand, cavity, fields};
use riprap::lattice::{Face, Force, State};
use std::f64::consts::{PI, TAU};

/// Half height, cells: 4.5 wall units a cell, the first centre at y⁺ = 2.2.
const H: u32 = 40;
/// Streamwise, between the walls, spanwise: long enough for the streaks, 6h × 2h × 3h.
const CELLS: [u32; 3] = [6 * H, 2 * H, 3 * H];
/// Friction velocity: the centre line moves at 0.1.
const FRICTION: f64 = 0.0055;
const REYNOLDS: f64 = 178.12;
/// Times h/u_τ until the flow has forgotten its start, and over which the mean is taken.
const SETTLE: f64 = 15.0;
const AVERAGE: f64 = 20.0;
const SAMPLES: u32 = 200;
/// Of the mean velocity at y⁺ > 10.
const LIMIT: f64 = 0.05;

/// Runs the case where a GPU is at hand: it is 6·10¹¹ cell updates.
pub fn run(stand: &Stand) -> Outcome {
    if stand.software {
        println!("     left out, it needs a GPU: 6·10¹¹ cell updates");
        return Ok(Vec::new());
    }
    let h = f64::from(H);
    let nu = FRICTION * h / REYNOLDS;
    let mut setup = stand.setup(CELLS, nu);
    setup.faces[1] = [Face::Wall([0.0; 3]), Face::Wall([0.0; 3])];
    setup.force = Force::Constant([FRICTION * FRICTION / h, 0.0, 0.0]);
    setup.wale = Some(0.5);
    let mut flow = stand.flow(setup, &start(), true)?;
    let turn = h / FRICTION;
    flow.advance((SETTLE * turn) as u64)?;
    let mut profile = vec![0.0; 2 * H as usize];
    for _ in 0..SAMPLES {
        flow.advance((AVERAGE * turn / f64::from(SAMPLES)) as u64)?;
        add_profile(&mut profile, &flow.state()?);
    }
    // Both halves are the same flow.
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
    let share = 1.0 / f64::from(CELLS[0] * CELLS[2] * SAMPLES);
    for (n, &u) in state.velocity[0].iter().enumerate() {
        let y = (n / CELLS[0] as usize) % CELLS[1] as usize;
        profile[y] += share * f64::from(u);
    }
}

/// A turbulent mean profile (Reichardt 1951) with rolls along the stream and waves across it, strong
/// enough to break up.
fn start() -> State {
    let [nx, _, nz] = CELLS.map(f64::from);
    let h = f64::from(H);
    fields::state(CELLS, |[x, y, z]| {
        let wall = (h - (y - h).abs()) / h * REYNOLDS;
        let mean = (1.0 + 0.4 * wall).ln() / 0.4
            + 7.8 * (1.0 - (-wall / 11.0).exp() - wall / 11.0 * (-wall / 3.0).exp());
        // ψ = (1 + cos πη)² sin kz with η from the centre: no slip and no flow through the walls.
        let eta = PI * (y - h) / h;
        let (shape, steep) = (
            (1.0 + eta.cos()).powi(2),
            -2.0 * (1.0 + eta.cos()) * eta.sin() * PI / h,
        );
        let mut u = [FRICTION * mean, 0.0, 0.0];
        for mode in 1..6u32 {
            let k = TAU * f64::from(mode) / nz;
            let l = TAU * f64::from(mode % 3 + 1) / nx;
            let phase = l * x + PI * fields::noise(mode);
            let size = 0.6 * FRICTION / k.max(2.0 * PI / h);
            u[1] += size * k * shape * (k * z + phase.sin()).cos();
            u[2] -= size * steep * (k * z + phase.sin()).sin();
            u[0] += 0.5 * FRICTION * shape * (k * z + phase).sin();
        }
        (0.0, u)
    })
}
