//! Flow between two plates that are blocks: Poiseuille's, between surfaces that lie a little outside of where they should.

use crate::validate::{
    Method, Outcome, Stand, Trial,
    tank::{self, Tank, block, numbers},
};
use anyhow::Context;
use riprap::scene::{BlockShape, Field, Motion};

/// Thickness of the plate, cells: the one between two gaps of a box that repeats.
const THICK: u32 = 8;
/// Where its middle is, from a side of a cell, cells.
const OFFSETS: [f64; 3] = [0.0, 0.3, 0.5];
/// Cells along the plate.
const WIDE: u32 = 4;
/// Steps after which swings of the start are gone from narrow gaps.
const LEAST: f64 = 1000.0;
/// Largest velocity aimed at.
const SPEED: f64 = 0.01;

/// How far surfaces lie outside, and what joints of few cells carry.
pub fn run(stand: &Stand) -> Outcome {
    let mut records = Vec::new();
    for tau in [0.55, 0.6, 1.0] {
        for offset in OFFSETS {
            let flow = Flow::measure(stand, 12, tau, offset)?;
            let quantity =
                format!("surface {offset} off the grid lies outside by, cells, τ = {tau}");
            records.push(flow.trial.at_most(quantity, flow.outside.abs(), 0.1));
        }
    }
    for gap in [1, 2, 3, 6] {
        for tau in [0.52, 0.6, 1.0] {
            let flow = Flow::measure(stand, gap, tau, 0.0)?;
            let quantity = format!("flow / Poiseuille's, {gap} cells, τ = {tau}");
            records.push(flow.trial.relative(quantity, flow.carried, 1.0, None));
        }
    }
    Ok(records)
}

/// A steady flow between plates.
struct Flow {
    /// How far their surfaces lie outside of where they should by the velocity in the middle, cells.
    outside: f64,
    /// What flows through, over what should.
    carried: f64,
    trial: Trial,
}

impl Flow {
    /// Through a gap of so many cells, with the plate's middle off the grid by `offset`.
    fn measure(stand: &Stand, gap: u32, tau: f64, offset: f64) -> anyhow::Result<Self> {
        let height = gap + THICK;
        let nu = (tau - 0.5) / 3.0;
        let width = f64::from(gap);
        let push = 8.0 * nu * SPEED / (width * width);
        let mut scene = tank::scene([WIDE, WIDE, height], tau)?;
        scene.fluid.acceleration = numbers([push, 0.0, 0.0]);
        let size = [f64::from(WIDE), f64::from(WIDE), f64::from(THICK)];
        let middle = [0.5 * f64::from(WIDE), 0.5 * f64::from(WIDE), offset];
        let plate = BlockShape::Box { size };
        scene.blocks.push(block(plate, middle, Motion::Fixed));
        Method::DEFAULT.choose(&mut scene);
        let mut tank = Tank::fill(stand, &scene)?;
        // Eight times in which the slowest profile falls to a third; what cells reflect swings with two and four steps.
        let time = (8.0 * width * width / (nu * 9.87)).max(LEAST);
        tank.advance(time as u64)?;
        let column: Vec<u32> = (0..height).map(|z| WIDE * WIDE * z).collect();
        let mut profile = vec![0.0; column.len()];
        for _ in 0..4 {
            tank.advance(1)?;
            let read = tank.read(&[Field::Velocity], &column)?;
            let velocity = read.first().context("no velocity")?;
            for (sum, u) in profile.iter_mut().zip(velocity.values.chunks(3)) {
                *sum += 0.25 * f64::from(u[0]);
            }
        }
        let centre = 0.5 * f64::from(height) + offset;
        let distance = |z: usize| z as f64 + 0.5 - centre;
        let (z, fastest) = (0..profile.len())
            .map(|z| (z, profile[z]))
            .min_by(|a, b| distance(a.0).abs().total_cmp(&distance(b.0).abs()))
            .context("no cell")?;
        let apparent = (8.0 * nu * fastest / push + 4.0 * distance(z).powi(2)).sqrt();
        let through: f64 = profile.iter().sum();
        Ok(Self {
            outside: 0.5 * (width - apparent),
            carried: through * 12.0 * nu / (push * width.powi(3)),
            trial: tank.trial(&format!("plates {gap} apart")),
        })
    }
}
