//! Channel flows that separate at an edge and reattach to the floor: behind a step, and around a cube.
//!
//! The stream is along x and the floor normal to y; h is the height of the step or the cube. A periodic channel that runs
//! alongside supplies the turbulent inflow.

use super::{CaseContext, Flow, Outcome, Record, fields};
use anyhow::Context;
use riprap::lattice::{Face, Force, WallModel};
use std::ops::Range;

/// Mean velocity of the inlet, cells per step.
const BULK: f64 = 0.05;
const WALL: Face = Face::Wall([0.0; 3]);
/// Reynolds number with the mean velocity and the hydraulic diameter 2h of the inlet, and reattachment over h (Erturk 2008).
const LAMINAR_STEP: [(f64, f64); 2] = [(100.0, 2.922), (200.0, 4.982)];
const LAMINAR_LIMIT: f64 = 0.03;
/// Reynolds number with the mean velocity and h, and reattachment over h (Kopera, Kerr, Blackburn & Barkley 2017).
const STEP: (f64, f64) = (9000.0, 8.62);
const STEP_LIMIT: f64 = 0.1;
/// Reynolds number with the mean velocity and h, and the lengths, over h, of separation before the cube and of reattachment
/// behind it (Martinuzzi & Tropea 1993).
const CUBE: (f64, f64, f64) = (40_000.0, 1.04, 1.61);
const CUBE_LIMIT: f64 = 0.15;

/// Steps between updates of the inlet: the stream moves a quarter of a cell.
const KEEP: u64 = 5;
/// Times h/u_τ until the periodic channel no longer depends on its start.
const DEVELOP: f64 = 6.0;
/// Times h/U until a turbulent flow no longer depends on its start, and over which means are taken.
const SETTLE: f64 = 30.0;
const AVERAGE: f64 = 50.0;
/// Batches of that time, whose means give the error of the whole mean, and states in each.
const BATCHES: usize = 8;
const SAMPLES: u64 = 50;

#[derive(Clone, Copy, Debug)]
enum Regime {
    Laminar,
    Turbulent(Option<WallModel>),
}

/// The two turbulent regimes that are compared: with a wall model and without.
const TURBULENT: [(Regime, &str); 2] = [
    (Regime::Turbulent(Some(WallModel::WernerWengle)), ""),
    (Regime::Turbulent(None), ", no model"),
];

/// A channel with a body on its floor; lengths in cells.
#[derive(Clone, Debug)]
struct Channel {
    h: u32,
    cells: [u32; 3],
    /// Extent of the body along x and z; it is h high.
    body: [Range<u32>; 2],
    regime: Regime,
}

/// The flow in a [`Channel`], and the channel that feeds its inlet.
struct Stream<'a> {
    flow: Flow<'a>,
    upstream: Option<Upstream<'a>>,
}

/// A periodic channel of turbulent water.
struct Upstream<'a> {
    flow: Flow<'a>,
    cells: [u32; 3],
    /// Rows of cells below the channel at the inlet.
    below: u32,
}

/// Laminar, plane flow behind a step. The edge makes the error first-order: the coarse grid shows it.
pub fn laminar_step(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    for h in [8, 16] {
        for (reynolds, expected) in LAMINAR_STEP {
            let channel = Channel::step(h, 16, 4, Regime::Laminar);
            let time = f64::from(h) / BULK;
            let mut stream = channel.stream(context, 2.0 * f64::from(h) * BULK / reynolds)?;
            stream.advance((80.0 * time) as u64)?;
            let before = channel.reattachment(&channel.on_floor(&mut stream, 1, 1)?)?;
            stream.advance((10.0 * time) as u64)?;
            let found = channel.reattachment(&channel.on_floor(&mut stream, 1, 1)?)?;
            let trial = stream.flow.trial();
            let name = |what: &str| format!("Re {reynolds:.0}, h of {h} cells: {what}");
            let length = name("reattachment / h");
            records.push(trial.relative(length, found, expected, LAMINAR_LIMIT));
            let change = name("its change in the last 10 h/U");
            records.push(trial.report(change, (found - before).abs()));
        }
    }
    Ok(records)
}

/// Cells across h in turbulent flows: for a CPU of two cores within minutes, and for a GPU.
fn fineness(context: &CaseContext) -> u32 {
    if context.software { 12 } else { 24 }
}

/// Turbulent flow behind a step.
pub fn step(context: &CaseContext) -> Outcome {
    let (reynolds, expected) = STEP;
    let mut records = Vec::new();
    for (regime, name) in TURBULENT {
        let h = fineness(context);
        let channel = Channel::step(h, 20, 4 * h, regime);
        let (stream, batches) = channel.batches(context, reynolds)?;
        let length = format!("step{name}: reattachment / h");
        let found = place(&batches, |u| channel.reattachment(u))?;
        let limit = channel.limit(STEP_LIMIT);
        records.extend(judge(&stream, &length, found, expected, limit));
    }
    Ok(records)
}

/// Turbulent flow around a cube.
pub fn cube(context: &CaseContext) -> Outcome {
    let (reynolds, before, behind) = CUBE;
    let mut records = Vec::new();
    for (regime, name) in TURBULENT {
        let h = fineness(context);
        let channel = Channel {
            h,
            cells: [10 * h, 2 * h, 7 * h],
            body: [3 * h..4 * h, 3 * h..4 * h],
            regime,
        };
        let (stream, batches) = channel.batches(context, reynolds)?;
        let length = format!("cube{name}: reattachment / h");
        let found = place(&batches, |u| channel.reattachment(u))?;
        let limit = channel.limit(CUBE_LIMIT);
        records.extend(judge(&stream, &length, found, behind, limit));
        let length = format!("cube{name}: separation before it / h");
        let found = place(&batches, |u| channel.separation(u))?;
        records.extend(judge(&stream, &length, found, before, None));
    }
    Ok(records)
}

/// A position derived from the mean of all batches, and its standard error from the means without one of them (jackknife).
fn place(
    batches: &[Vec<f64>],
    of: impl Fn(&[f64]) -> anyhow::Result<f64>,
) -> anyhow::Result<[f64; 2]> {
    let count = batches.len() as f64;
    let mean_without = |left_out: Option<usize>| {
        let parts = batches.iter().enumerate();
        let parts = parts.filter(|(n, _)| Some(*n) != left_out);
        let share = 1.0 / (count - f64::from(u8::from(left_out.is_some())));
        let mut mean = vec![0.0; batches[0].len()];
        for (_, part) in parts {
            mean.iter_mut()
                .zip(part)
                .for_each(|(sum, u)| *sum += share * u);
        }
        of(&mean)
    };
    let places: Vec<f64> = (0..batches.len())
        .map(|n| mean_without(Some(n)))
        .collect::<anyhow::Result<_>>()?;
    let mean = places.iter().sum::<f64>() / count;
    let squares: f64 = places.iter().map(|place| (place - mean).powi(2)).sum();
    Ok([
        mean_without(None)?,
        (squares * (count - 1.0) / count).sqrt(),
    ])
}

/// Records of a position and its standard error.
fn judge(
    stream: &Stream<'_>,
    quantity: &str,
    [place, error]: [f64; 2],
    expected: f64,
    limit: Option<f64>,
) -> [Record; 2] {
    let trial = stream.flow.trial();
    [
        trial.relative(quantity, place, expected, limit),
        trial.report(format!("{quantity}, its standard error"), error),
    ]
}

impl Channel {
    /// The channel behind a step, which begins at the inlet and is four heights long.
    fn step(h: u32, behind: u32, wide: u32, regime: Regime) -> Self {
        Self {
            h,
            cells: [(4 + behind) * h, 2 * h, wide],
            body: [0..4 * h, 0..wide],
            regime,
        }
    }

    /// Limit on the error of the length; none for flows without a wall model, which are for comparison.
    fn limit(&self, limit: f64) -> Option<f64> {
        match self.regime {
            Regime::Turbulent(None) => None,
            _ => Some(limit),
        }
    }

    fn is_solid(&self, [x, y, z]: [f64; 3]) -> bool {
        let within =
            |range: &Range<u32>, at| f64::from(range.start) < at && at < f64::from(range.end);
        y < f64::from(self.h) && within(&self.body[0], x) && within(&self.body[1], z)
    }

    /// Floor level and height of the inlet.
    fn inlet(&self) -> [f64; 2] {
        let floor = if self.body[0].start == 0 { self.h } else { 0 };
        [floor, self.cells[1] - floor].map(f64::from)
    }

    /// Velocity profile of the inlet.
    fn profile(&self, y: f64) -> f64 {
        let [floor, height] = self.inlet();
        // 0 at the walls, 1 in the middle.
        let depth = (1.0 - (2.0 * (y - floor) / height - 1.0).abs()).max(0.0);
        match self.regime {
            Regime::Laminar => 1.5 * BULK * depth * (2.0 - depth),
            Regime::Turbulent(_) => 8.0 / 7.0 * BULK * depth.powf(1.0 / 7.0),
        }
    }

    /// The flow at its start, with the inlet profile everywhere above the floor.
    fn stream<'a>(&self, context: &'a CaseContext, nu: f64) -> anyhow::Result<Stream<'a>> {
        let [_, ny, nz] = self.cells;
        let mut setup = context.setup(self.cells, nu);
        let centres = || fields::centres(self.cells);
        setup.solid = centres().map(|at| self.is_solid(at)).collect();
        let inlet = (0..ny * nz).map(|n| [self.profile(f64::from(n % ny) + 0.5) as f32, 0.0, 0.0]);
        let outlet = match self.regime {
            Regime::Laminar => Face::Pressure { density: 1.0 },
            Regime::Turbulent(_) => Face::Outflow { density: 1.0 },
        };
        setup.faces[0] = [Face::Velocity(inlet.collect()), outlet];
        setup.faces[1] = [WALL, WALL];
        let mut upstream = None;
        if let Regime::Turbulent(model) = self.regime {
            setup.wale = Some(0.5);
            setup.wall_model = model;
            let [floor, height] = self.inlet().map(|cells| cells as u32);
            let cells = [(2 * height).next_multiple_of(16), height, nz];
            upstream = Some(Upstream::develop(context, cells, floor, nu)?);
        }
        let start = fields::state(self.cells, |at| {
            let u = if self.is_solid(at) {
                0.0
            } else {
                self.profile(at[1])
            };
            (0.0, [u, 0.0, 0.0])
        });
        let flow = context.flow(setup, &start, true)?;
        Ok(Stream { flow, upstream })
    }

    /// A developed turbulent flow, and the result of [`Self::on_floor`] for each batch.
    fn batches<'a>(
        &self,
        context: &'a CaseContext,
        reynolds: f64,
    ) -> anyhow::Result<(Stream<'a>, Vec<Vec<f64>>)> {
        let h = f64::from(self.h);
        let mut stream = self.stream(context, h * BULK / reynolds)?;
        stream.advance((SETTLE * h / BULK) as u64)?;
        // Odd, so that populations that alternate at walls contribute both of their states.
        let each = (AVERAGE * h / BULK / (BATCHES as f64 * SAMPLES as f64)) as u64 | 1;
        let batch = |_| self.on_floor(&mut stream, SAMPLES, each);
        let batches = (0..BATCHES).map(batch).collect::<anyhow::Result<_>>()?;
        Ok((stream, batches))
    }

    /// Streamwise direction of the friction on the floor: the mean velocity in the cells on it or, for laminar flow, the slope at
    /// the floor of the parabola through two cells. The mean is over states `each` steps apart and, across the stream, over the
    /// two columns in the middle of the body, or over all columns for a step.
    fn on_floor(
        &self,
        stream: &mut Stream<'_>,
        samples: u64,
        each: u64,
    ) -> anyhow::Result<Vec<f64>> {
        let [nx, ny, nz] = self.cells.map(|n| n as usize);
        let across = &self.body[1];
        let middle = (across.start + across.end) as usize / 2;
        let columns = if across.len() == nz {
            0..nz
        } else {
            middle - 1..middle + 1
        };
        let weights = match self.regime {
            Regime::Laminar => [3.0, -1.0 / 3.0],
            Regime::Turbulent(_) => [1.0, 0.0],
        };
        let share = 1.0 / (samples as f64 * columns.len() as f64);
        let mut mean = vec![0.0; nx];
        for _ in 0..samples {
            stream.advance(each)?;
            let state = stream.flow.state()?;
            for z in columns.clone() {
                for (y, weight) in weights.into_iter().enumerate() {
                    let row = &state.velocity[0][nx * (ny * z + y)..][..nx];
                    for (sum, u) in mean.iter_mut().zip(row) {
                        *sum += weight * share * f64::from(*u);
                    }
                }
            }
        }
        Ok(mean)
    }

    /// Position over h, from the rear of the body, of the last change from backward to forward flow on the floor behind it.
    fn reattachment(&self, u: &[f64]) -> anyhow::Result<f64> {
        let rear = self.body[0].end as usize;
        let last = (rear..u.len() - 1)
            .rev()
            .find(|&n| u[n] < 0.0 && u[n + 1] >= 0.0);
        let n = last.context("the flow does not come back to the floor")?;
        Ok((crossing(u, n) - rear as f64) / f64::from(self.h))
    }

    /// Position over h, from the front of the body, of the first change from forward to backward flow before it.
    fn separation(&self, u: &[f64]) -> anyhow::Result<f64> {
        let front = self.body[0].start as usize;
        let first = (1..front).find(|&n| u[n - 1] >= 0.0 && u[n] < 0.0);
        let n = first.context("the flow does not separate before the body")?;
        Ok((front as f64 - crossing(u, n - 1)) / f64::from(self.h))
    }
}

impl Stream<'_> {
    fn advance(&mut self, steps: u64) -> anyhow::Result<()> {
        let Some(upstream) = &mut self.upstream else {
            return self.flow.advance(steps);
        };
        let mut left = steps;
        while left > 0 {
            let some = left.min(KEEP);
            self.flow.set_inlet(upstream.inlet(some)?)?;
            self.flow.advance(some)?;
            left -= some;
        }
        Ok(())
    }
}

impl<'a> Upstream<'a> {
    /// A developed channel, always with a wall model.
    fn develop(
        context: &'a CaseContext,
        cells: [u32; 3],
        below: u32,
        nu: f64,
    ) -> anyhow::Result<Self> {
        let h = 0.5 * f64::from(cells[1]);
        // Re_τ of a channel (Pope 2000, eq. 7.9 and 7.10).
        let reynolds = 0.09 * (2.0 * h * BULK / nu).powf(0.88);
        let friction = reynolds * nu / h;
        let mut setup = context.setup(cells, nu);
        setup.faces[1] = [WALL, WALL];
        setup.force = Force::Constant([friction * friction / h, 0.0, 0.0]);
        setup.wale = Some(0.5);
        setup.wall_model = Some(WallModel::WernerWengle);
        let start = fields::turbulent_channel(cells, h, friction, reynolds);
        let mut flow = context.flow(setup, &start, true)?;
        flow.advance((DEVELOP * h / friction) as u64)?;
        Ok(Self { flow, cells, below })
    }

    /// Velocity of the inlet after further steps: that of one plane of the channel, scaled to the mean velocity of the inlet.
    fn inlet(&mut self, steps: u64) -> anyhow::Result<Vec<[f32; 3]>> {
        self.flow.advance(steps)?;
        let state = self.flow.state()?;
        let [nx, ny, nz] = self.cells;
        let rows = || (0..ny * nz).map(|row| (row * nx) as usize);
        let mean =
            rows().map(|n| f64::from(state.velocity[0][n])).sum::<f64>() / f64::from(ny * nz);
        let share = (BULK / mean) as f32;
        let mut inlet = Vec::new();
        for z in 0..nz {
            inlet.extend((0..self.below).map(|_| [0.0; 3]));
            let row = |y| ((z * ny + y) * nx) as usize;
            inlet.extend(
                (0..ny).map(|y| [0, 1, 2].map(|a: usize| share * state.velocity[a][row(y)])),
            );
        }
        Ok(inlet)
    }
}

/// Zero of the line through the values of the cells n and n + 1.
fn crossing(u: &[f64], n: usize) -> f64 {
    n as f64 + 0.5 + u[n] / (u[n] - u[n + 1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flow_separates_and_comes_back_where_it_changes_its_sign() {
        let channel = Channel {
            cells: [20, 4, 4],
            body: [8..10, 0..4],
            ..Channel::step(2, 6, 4, Regime::Laminar)
        };
        // Separation between the centres of cells 4 and 5, a quarter of a cell from the first; reattachment half a cell behind
        // cell 13.
        let mut u = [1.0; 20];
        (u[4], u[5], u[6], u[7]) = (1.0, -3.0, -1.0, -1.0);
        (u[10], u[11], u[12], u[13], u[14]) = (0.5, -1.0, -1.0, -1.0, 1.0);
        assert_eq!(channel.separation(&u).unwrap(), (8.0 - 4.75) / 2.0);
        assert_eq!(channel.reattachment(&u).unwrap(), (14.0 - 10.0) / 2.0);
        assert!(channel.reattachment(&[1.0; 20]).is_err());
        assert!(channel.separation(&[1.0; 20]).is_err());
        // Batches whose mean is u: the same position, and an error from their difference.
        let shifted = |by: f64| u.map(|u| u + by).to_vec();
        let [same, none] = place(&[u.to_vec(), u.to_vec()], |u| channel.reattachment(u)).unwrap();
        let [mean, error] =
            place(&[shifted(0.5), shifted(-0.5)], |u| channel.reattachment(u)).unwrap();
        assert_eq!((same, none), (2.0, 0.0));
        assert_eq!((mean, error), (2.0, 0.125));
    }
}
