//! Synthetic turbulence of a velocity face: its intensity on the face and in the fluid.

use super::{CaseContext, Outcome, fields};
use riprap::lattice::{Face, SyntheticTurbulence};

const CELLS: [u32; 3] = [32, 20, 20];
const SPEED: f64 = 0.05;
const TURBULENCE: SyntheticTurbulence = SyntheticTurbulence {
    intensity: 0.1,
    length: 4.0,
    seed: 1,
};
/// Steps before the measurement: the water is replaced twice.
const SETTLE: u64 = 1_280;
const EVERY: u64 = 20;
const SAMPLES: u64 = 240;
/// Limit on the relative error of the RMS of each component on the face.
const LIMIT: f64 = 0.03;
/// Planes at which the fluid is sampled, in eddy lengths behind the face.
const PLANES: [u32; 3] = [0, 1, 4];

/// Root mean square of each component about the mean flow, on the face and behind it.
pub fn inlet(context: &CaseContext) -> Outcome {
    let [nx, ny, nz] = CELLS;
    let mean = [SPEED, 0.0, 0.0];
    let mut setup = context.setup(CELLS, 1e-5);
    setup.wale = Some(0.5);
    let faces = vec![mean.map(|u| u as f32); (ny * nz) as usize];
    setup.faces[0] = [Face::Velocity(faces), Face::Outflow { density: 1.0 }];
    setup.turbulence[0][0] = Some(TURBULENCE);
    let start = fields::state(CELLS, |_| (0.0, mean));
    let mut flow = context.flow(setup, &start, true)?;
    flow.advance(SETTLE)?;
    let mut on_face = [0.0; 3];
    let mut behind = [[0.0; 3]; PLANES.len()];
    let square = |u: f32, a: usize| (f64::from(u) - mean[a]).powi(2);
    for _ in 0..SAMPLES {
        flow.advance(EVERY)?;
        for cell in flow.wall_velocities()?.chunks(9) {
            for a in 0..3 {
                on_face[a] += square(cell[a], a);
            }
        }
        let state = flow.state()?;
        for (plane, sums) in PLANES.iter().zip(&mut behind) {
            let x = plane * TURBULENCE.length as u32;
            for row in 0..ny * nz {
                for a in 0..3 {
                    sums[a] += square(state.velocity[a][(x + nx * row) as usize], a);
                }
            }
        }
    }
    let count = (SAMPLES * u64::from(ny * nz)) as f64;
    let target = TURBULENCE.intensity * SPEED;
    let rms = |sum: f64| (sum / count).sqrt() / target;
    let trial = flow.trial();
    let mut records = Vec::new();
    for (name, sum) in ["x", "y", "z"].into_iter().zip(on_face) {
        let quantity = format!("face: RMS of u_{name} over the intensity");
        records.push(trial.relative(quantity, rms(sum), 1.0, LIMIT));
    }
    for (plane, sums) in PLANES.into_iter().zip(behind) {
        let quantity = format!("fluid, {plane} eddy lengths behind it: RMS over the intensity");
        let all = sums.iter().sum::<f64>() / 3.0;
        records.push(trial.report(quantity, rms(all)));
    }
    Ok(records)
}
