//! Walls whose friction a law of the wall gives, where the grid does not resolve the layer next to them.

use super::{Outcome, Record, Stand, fields};
use riprap::lattice::{Face, Force, WallModel};

/// Streamwise, between the walls, spanwise.
const CELLS: [u32; 3] = [48, 24, 24];
/// Mean velocity of the start.
const BULK: f64 = 0.04;
const WALLS: [Face; 2] = [Face::Wall([0.0; 3]), Face::Wall([0.0; 3])];
/// Times h/u_τ until the flow has forgotten its start, and over which means are taken.
const SETTLE: f64 = 6.0;
const AVERAGE: f64 = 8.0;
const SAMPLES: u64 = 100;
/// Of the mean velocity over the friction velocity.
const LIMIT: f64 = 0.05;
/// Re_τ and the mean velocity over the friction velocity (Lee & Moser 2015).
const CHANNELS: [(f64, f64); 2] = [(1000.0, 19.99), (5200.0, 24.1)];

/// What a channel has on average.
struct Means {
    /// Mean velocity over the friction velocity, from the momentum that the fluid loses.
    bulk: f64,
    /// Mean of the stresses that the walls report, over the momentum that the fluid loses.
    reported: f64,
    /// Mean velocity of each layer from a wall to the middle, over the friction velocity.
    profile: Vec<f64>,
    /// Least increase from one layer to the next.
    steepest: f64,
}

/// Mean velocity and profile of channels with and without the model.
pub fn channel(stand: &Stand) -> Outcome {
    let mut records = Vec::new();
    for (reynolds, expected) in CHANNELS {
        for model in [Some(WallModel::WernerWengle), None] {
            records.extend(run(stand, reynolds, expected, model)?);
        }
    }
    Ok(records)
}

fn run(
    stand: &Stand,
    reynolds: f64,
    expected: f64,
    model: Option<WallModel>,
) -> anyhow::Result<Vec<Record>> {
    let h = f64::from(CELLS[1]) / 2.0;
    let friction = BULK / expected;
    let drive = friction * friction / h;
    let mut setup = stand.setup(CELLS, friction * h / reynolds);
    setup.faces[1] = WALLS;
    setup.force = Force::Constant([drive, 0.0, 0.0]);
    setup.wale = Some(0.5);
    setup.wall_model = model;
    let start = fields::turbulent_channel(CELLS, friction, reynolds);
    let mut flow = stand.flow(setup, &start, true)?;
    let turn = h / friction;
    flow.advance((SETTLE * turn) as u64)?;
    let each = (AVERAGE * turn) as u64 / SAMPLES;
    let mut layers = vec![0.0; CELLS[1] as usize];
    let mut bulk = Vec::new();
    let mut reported = 0.0;
    for _ in 0..=SAMPLES {
        flow.advance(each | 1)?;
        let state = flow.state()?;
        let mut mean = 0.0;
        for (n, &u) in state.velocity[0].iter().enumerate() {
            layers[(n / CELLS[0] as usize) % CELLS[1] as usize] += f64::from(u);
            mean += f64::from(u) / state.velocity[0].len() as f64;
        }
        bulk.push(mean);
        if model.is_some() {
            let walls = flow.wall_stresses()?;
            let sum: f64 = walls.iter().map(|wall| f64::from(wall.stress[0])).sum();
            reported += sum / walls.len() as f64 / (SAMPLES + 1) as f64;
        }
    }
    // The fluid loses what the force gives it and it does not keep.
    let steps = (SAMPLES * (each | 1)) as f64;
    let change = (bulk[bulk.len() - 1] - bulk[0]) / steps;
    let stress = h * (drive - change);
    let scale = 1.0 / ((SAMPLES + 1) * u64::from(CELLS[0] * CELLS[2])) as f64 / stress.sqrt();
    let half = CELLS[1] as usize / 2;
    let profile: Vec<f64> = (0..half)
        .map(|y| scale * (layers[y] + layers[2 * half - 1 - y]) / 2.0)
        .collect();
    let steps = profile.windows(2).map(|pair| pair[1] - pair[0]);
    let means = Means {
        bulk: bulk.iter().sum::<f64>() / bulk.len() as f64 / stress.sqrt(),
        reported: reported / stress,
        steepest: steps.fold(f64::INFINITY, f64::min),
        profile,
    };
    println!("{:?} {:?}", means.bulk, means.profile);
    let trial = flow.trial();
    let name = format!("Re_τ {reynolds:.0}");
    Ok(match model {
        None => vec![trial.relative(
            format!("{name}, no model: U_b⁺"),
            means.bulk,
            expected,
            None,
        )],
        Some(_) => vec![
            trial.relative(format!("{name}: U_b⁺"), means.bulk, expected, LIMIT),
            trial.at_least(
                format!("{name}: U⁺ of the first cell"),
                means.profile[0],
                0.0,
            ),
            trial.at_least(
                format!("{name}: least increase of U⁺ from cell to cell"),
                means.steepest,
                0.0,
            ),
            trial.relative(
                format!("{name}: reported stress over momentum lost"),
                means.reported,
                1.0,
                1e-2,
            ),
        ],
    })
}
