//! Mass and momentum of a periodic box over 10⁴ steps.

use super::{
    Outcome, Stand,
    fields::changed,
    golden::{noise_and_shear, suga, with_own_velocity},
};
use riprap::lattice::{C, Collision, Populations, Storage};

const CELLS: [u32; 3] = [16, 16, 16];
const STEPS: u64 = 10_000;
/// Of Σf and of Σ|c f̃|: round-off of f32 in random directions.
const LIMIT: f64 = 1e-6;

/// Runs the case.
pub fn run(stand: &Stand) -> Outcome {
    let hermite = stand.setup(CELLS, 0.05 / 3.0);
    let setups = [
        hermite.clone(),
        changed(&suga(CELLS), |s| s.lanes = hermite.lanes),
        changed(&hermite, |s| s.collision = Collision::Bgk),
        changed(&hermite, |s| s.wale = Some(0.5)),
        changed(&hermite, |s| (s.storage, s.lanes) = (Storage::F16, 4)),
    ];
    let mut records = Vec::new();
    for setup in setups {
        let limit = (setup.storage == Storage::F32).then_some(LIMIT);
        let start = with_own_velocity(noise_and_shear(CELLS));
        let before = Totals::of(&start);
        let mut flow = stand.resumed(setup, &start)?;
        flow.advance(STEPS)?;
        let after = Totals::of(&flow.populations()?);
        let mass = (after.mass - before.mass).abs() / before.mass;
        let momentum = (0..3)
            .map(|a| (after.momentum[a] - before.momentum[a]).abs() / before.scale[a])
            .fold(0.0, f64::max);
        let trial = flow.trial();
        for (quantity, drift) in [("drift of Σf", mass), ("drift of Σ c f̃ / Σ|c f̃|", momentum)]
        {
            records.push(trial.at_most(quantity, drift, limit));
        }
    }
    Ok(records)
}

struct Totals {
    mass: f64,
    momentum: [f64; 3],
    /// Σ |c f̃| of each axis.
    scale: [f64; 3],
}

impl Totals {
    fn of(populations: &Populations) -> Self {
        let n = populations.values.len() / 27;
        let mut totals = Self {
            mass: n as f64,
            momentum: [0.0; 3],
            scale: [0.0; 3],
        };
        for (at, &f) in populations.values.iter().enumerate() {
            let f = f64::from(f);
            totals.mass += f;
            for a in 0..3 {
                let c = f64::from(C[at / n][a]);
                totals.momentum[a] += c * f;
                totals.scale[a] += (c * f).abs();
            }
        }
        totals
    }
}
