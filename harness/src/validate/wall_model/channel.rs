//! Channels between walls of the domain.

use super::{BULK, CHANNELS, SAMPLES, mean_and_stress};
use crate::validate::{CaseContext, Flow, Outcome, Record, fields};
use riprap::lattice::{Face, Force, WallModel};

const WALL: Face = Face::Wall([0.0; 3]);
/// Limit on the relative error of the mean velocity over the friction velocity.
const LIMIT: f64 = 0.05;

/// A channel 4 depths long and 2 depths wide, between walls or between a wall and a face without friction.
#[derive(Clone, Copy, Debug)]
struct Channel {
    /// Cells of the depth: from a wall to the middle or to the other face.
    depth: u32,
    /// Whether the other face is a wall too.
    closed: bool,
    reynolds: f64,
    /// Equivalent sand roughness, cells.
    roughness: f64,
    /// Mean velocity over the friction velocity.
    expected: f64,
    model: Option<WallModel>,
}

/// Averages of a channel.
struct Means {
    /// Mean velocity over the friction velocity, from the momentum that the fluid loses.
    bulk: f64,
    /// Mean of the stresses that the walls report, over the momentum that the fluid loses.
    reported: f64,
    /// Mean velocity of the cells next to the walls, over the friction velocity.
    first: f64,
    /// Least increase of the mean velocity, over the friction velocity, from one layer to the next.
    least_increase: f64,
}

/// Mean velocity and profile of channels with the model; in the long form on other grids too, and without the model.
pub fn channel(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    for (reynolds, expected) in CHANNELS {
        let usual = Channel {
            depth: 12,
            closed: true,
            reynolds,
            roughness: 0.0,
            expected,
            model: Some(WallModel::WernerWengle),
        };
        let others = [
            Channel { depth: 8, ..usual },
            Channel { depth: 16, ..usual },
            Channel {
                model: Some(WallModel::Reichardt),
                ..usual
            },
            Channel {
                model: None,
                ..usual
            },
        ];
        let others = others.into_iter().filter(|_| context.full);
        for channel in std::iter::once(usual).chain(others) {
            records.extend(channel.judge(context)?);
        }
    }
    Ok(records)
}

/// Water over a rough bed: U_b/u_τ = 2.5 ln(h/k_s) + 6.0 (Keulegan 1938), the mean of the log law of a rough wall over the depth.
pub fn rough_channel(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    for roughness in [0.1, 1.0] {
        let depth: u32 = 12;
        let channel = Channel {
            depth,
            closed: false,
            reynolds: 2e4,
            roughness,
            expected: 2.5 * (f64::from(depth) / roughness).ln() + 6.0,
            model: Some(WallModel::WernerWengle),
        };
        records.extend(channel.judge(context)?);
    }
    Ok(records)
}

impl Channel {
    /// Layers of cells across the channel.
    fn layers(&self) -> u32 {
        self.depth * if self.closed { 2 } else { 1 }
    }

    fn judge(&self, context: &CaseContext) -> anyhow::Result<Vec<Record>> {
        let h = f64::from(self.depth);
        let friction = BULK / self.expected;
        let cells = [4 * self.depth, self.layers(), 2 * self.depth];
        let mut setup = context.setup(cells, friction * h / self.reynolds);
        let other = if self.closed { WALL } else { Face::FreeSlip };
        setup.faces[1] = [WALL, other];
        setup.force = Force::Constant([friction * friction / h, 0.0, 0.0]);
        setup.wale = Some(0.5);
        setup.wall_model = self.model;
        setup.wall_roughness[1] = [self.roughness; 2];
        let mut start = fields::turbulent_channel(cells, h, friction, self.reynolds);
        // A rough wall shifts the profile.
        let u = &mut start.velocity[0];
        let mean = u.iter().map(|u| f64::from(*u)).sum::<f64>() / u.len() as f64;
        u.iter_mut().for_each(|u| *u += (BULK - mean) as f32);
        let mut flow = context.flow(setup, &start, true)?;
        // Times h/u_τ until the flow no longer depends on its start, and over which means are taken.
        let (settle, average) = if context.full {
            (8.0, 16.0)
        } else {
            (4.0, 4.0)
        };
        flow.advance((settle * h / friction) as u64)?;
        // Odd, so that populations that alternate at walls contribute both of their states.
        let each = ((average * h / friction) as u64 / SAMPLES) | 1;
        let means = self.average(&mut flow, friction * friction / h, each)?;
        let trial = flow.trial();
        let mut name = match self.roughness {
            0.0 => format!("Re_τ {:.0}, {} cells", self.reynolds, self.layers()),
            rough => format!("h/k_s {:.0}", h / rough),
        };
        name += match self.model {
            Some(WallModel::WernerWengle) => "",
            Some(WallModel::Reichardt) => ", Reichardt",
            None => ", no model",
        };
        let limit = self.model.map(|_| LIMIT);
        let bulk = trial.relative(format!("{name}: U_b⁺"), means.bulk, self.expected, limit);
        let first = format!("{name}: U⁺ of the first cell");
        let increase = format!("{name}: least increase of U⁺ from cell to cell");
        Ok(match self.model {
            None => vec![
                bulk,
                trial.report(first, means.first),
                trial.report(increase, means.least_increase),
            ],
            Some(_) => vec![
                bulk,
                trial.at_least(first, means.first, 0.0),
                trial.at_least(increase, means.least_increase, 0.0),
                trial.relative(
                    format!("{name}: stress that the walls report over that lost"),
                    means.reported,
                    1.0,
                    1e-2,
                ),
            ],
        })
    }

    /// Means over states `each` steps apart, in a flow driven by a force per volume.
    fn average(&self, flow: &mut Flow<'_>, force: f64, each: u64) -> anyhow::Result<Means> {
        let (h, layers) = (f64::from(self.depth), self.layers() as usize);
        let length = 4 * self.depth as usize;
        let mut rows = 0;
        let mut profile = vec![0.0; layers];
        let mut bulk = Vec::new();
        let mut reported = 0.0;
        for _ in 0..=SAMPLES {
            flow.advance(each)?;
            let state = flow.state()?;
            let u = &state.velocity[0];
            rows = u.len() / length / layers;
            let mut mean = 0.0;
            for (row, values) in u.chunks(length).enumerate() {
                let sum: f64 = values.iter().map(|u| f64::from(*u)).sum();
                profile[row % layers] += sum;
                mean += sum / u.len() as f64;
            }
            bulk.push(mean);
            if self.model.is_some() {
                let walls = flow.wall_stresses()?;
                let sum: f64 = walls.iter().map(|wall| f64::from(wall.stress[0])).sum();
                reported += sum / walls.len() as f64 / (SAMPLES + 1) as f64;
            }
        }
        let [bulk, stress] = mean_and_stress(&bulk, each, h, force);
        let cells = (SAMPLES + 1) as f64 * (length * rows) as f64;
        let mean = |y: usize| {
            let both = match self.closed {
                true => (profile[y] + profile[layers - 1 - y]) / 2.0,
                false => profile[y],
            };
            both / cells / stress.sqrt()
        };
        let increases = (1..self.depth as usize).map(|y| mean(y) - mean(y - 1));
        Ok(Means {
            bulk: bulk / stress.sqrt(),
            reported: reported / stress,
            first: mean(0),
            least_increase: increases.fold(f64::INFINITY, f64::min),
        })
    }
}
