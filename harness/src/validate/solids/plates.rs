//! Poiseuille and Couette flow between plates that are blocks: positions of their surfaces.

use crate::validate::{
    CaseContext, Method, Outcome, Record, Trial,
    tank::{self, Tank, block, numbers},
};
use anyhow::Context;
use glam::DVec3;
use riprap::scene::{BlockShape, Field, Motion, Rotation};

/// Thickness of the plate, cells; one plate separates the gaps of the periodic box.
const THICK: u32 = 8;
/// Offset of its middle from a face between cells, cells.
const OFFSETS: [f64; 3] = [0.0, 0.3, 0.5];
/// Cells along the plate.
const WIDE: u32 = 4;
/// Steps after which initial oscillations have decayed in narrow gaps.
const LEAST: f64 = 1000.0;
/// Target of the largest velocity, and velocity of moving plates.
const SPEED: f64 = 0.01;

/// Outward offset of the surfaces, and flow through joints of a few cells.
pub fn run(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    for (gap, limit) in [(8, 0.03), (32, 0.01)] {
        // The time to steady flow grows as the square of the gap.
        let taus: &[f64] = match gap > 8 && context.software {
            true => &[0.6, 1.0],
            false => &[0.52, 0.6, 1.0, 1.5],
        };
        for &tau in taus {
            for offset in OFFSETS {
                let flow = Flow::measure(context, gap, tau, offset)?;
                let quantity = format!(
                    "surface {offset} off the grid lies outside by, cells, τ = {tau}, gap of {gap}"
                );
                records.push(flow.trial.at_most(quantity, flow.outside.abs(), limit));
            }
        }
    }
    for gap in [1, 2, 3, 6] {
        for tau in [0.52, 0.6, 1.0] {
            let flow = Flow::measure(context, gap, tau, 0.0)?;
            let quantity = format!("flow / Poiseuille's, {gap} cells, τ = {tau}");
            records.push(flow.trial.relative(quantity, flow.carried, 1.0, None));
        }
    }
    Ok(records)
}

/// A steady flow between plates.
struct Flow {
    /// Outward offset of the surfaces from their nominal positions, by the velocity in the middle, cells.
    outside: f64,
    /// Flow rate over that of Poiseuille flow.
    carried: f64,
    trial: Trial,
}

impl Flow {
    /// Measures the flow through a gap of `gap` cells, with the plate's middle off the grid by `offset`.
    fn measure(context: &CaseContext, gap: u32, tau: f64, offset: f64) -> anyhow::Result<Self> {
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
        let mut tank = Tank::fill(context, &scene)?;
        // Eight times in which the slowest mode falls to a third; reflected populations alternate with periods of two and four
        // steps.
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

/// Positions of the surfaces of plates: along the grid by the friction on them, across the grid by the flux between them.
pub fn places(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    let taus: &[f64] = match context.full {
        true => &[0.52, 0.6, 1.0, 1.5],
        false => &[0.6, 1.0],
    };
    for &tau in taus {
        for offset in OFFSETS {
            records.push(shear(context, tau, offset)?);
        }
        for (normal, thick, limit) in [([2, 1], 5.0, 0.03), ([1, 1], 6.0, 0.06)] {
            for along_z in [true, false] {
                let slope = Slope {
                    normal,
                    thick,
                    tau,
                    along_z,
                };
                records.push(slope.measure(context, limit)?);
            }
        }
    }
    Ok(records)
}

/// Couette flow between plates along the grid, one at rest and one moving in its plane.
fn shear(context: &CaseContext, tau: f64, offset: f64) -> anyhow::Result<Record> {
    const GAP: u32 = 12;
    let nu = (tau - 0.5) / 3.0;
    let [gap, thick, wide] = [GAP, THICK, WIDE].map(f64::from);
    let mut scene = tank::scene([WIDE, WIDE, 2 * (GAP + THICK)], tau)?;
    for (n, motion) in [Motion::Fixed, Motion::Driven].into_iter().enumerate() {
        let plate = BlockShape::Box {
            size: [wide, wide, thick],
        };
        let height = offset + (gap + thick) * n as f64;
        scene
            .blocks
            .push(block(plate, [0.5 * wide, 0.5 * wide, height], motion));
    }
    scene.blocks[1].velocity = numbers([SPEED, 0.0, 0.0]);
    // The slowest initial mode falls to 1e-4; then the load is averaged.
    let tenth = (gap * gap / (nu * 9.87)).max(0.1 * LEAST) as u64;
    scene.coupling.interval = tenth as u32;
    let mut tank = Tank::fill(context, &scene)?;
    tank.advance(11 * tenth)?;
    let apparent = -2.0 * nu * SPEED * wide * wide / tank.load(1).flow.force.x;
    let quantity =
        format!("sheared surface {offset} off the grid lies outside by, cells, τ = {tau}");
    let outside = 0.5 * (gap - apparent);
    let trial = tank.trial("plates that shear the fluid between them");
    Ok(trial.at_most(quantity, outside.abs(), 0.005))
}

/// Edge along x and y of the periodic box with plates across the grid, cells.
const PERIOD: u32 = 32;

/// Poiseuille flow between plates parallel to z and to no other axis.
struct Slope {
    /// Normal of the plates in the plane of x and y, coprime integers.
    normal: [u32; 2],
    thick: f64,
    tau: f64,
    along_z: bool,
}

impl Slope {
    fn measure(&self, context: &CaseContext, limit: f64) -> anyhow::Result<Record> {
        let nu = (self.tau - 0.5) / 3.0;
        let period = f64::from(PERIOD);
        let [a, b] = self.normal.map(f64::from);
        let across = DVec3::new(a, b, 0.0).normalize();
        let along = DVec3::new(-b, a, 0.0).normalize();
        let spacing = period / a.hypot(b);
        let gap = spacing - self.thick;
        let direction = if self.along_z { DVec3::Z } else { along };
        let push = 8.0 * nu * SPEED / (gap * gap);
        let mut scene = tank::scene([PERIOD, PERIOD, WIDE], self.tau)?;
        scene.fluid.acceleration = numbers((push * direction).to_array());
        let middle = along * along.dot(0.5 * DVec3::new(period, period, f64::from(WIDE)));
        let plate = BlockShape::Box {
            size: [self.thick, 4.0 * period, 4.0 * period],
        };
        // The plates are so long that they have no periodic images: each repetition in the box is a block.
        for n in 0..=self.normal.iter().sum::<u32>() {
            let at = spacing * f64::from(n) * across + middle;
            let mut plate = block(plate.clone(), at.to_array(), Motion::Fixed);
            plate.rotation = Rotation {
                axis: [0.0, 0.0, 1.0],
                angle: b.atan2(a).to_degrees(),
            };
            scene.blocks.push(plate);
        }
        let mut tank = Tank::fill(context, &scene)?;
        tank.advance((10.0 * gap * gap / (nu * 9.87)).max(LEAST) as u64)?;
        let mut sum = DVec3::ZERO;
        for _ in 0..4 {
            tank.advance(1)?;
            sum += 0.25 * DVec3::from(tank.totals()?.momentum);
        }
        // Without the half force: in partially saturated cells it is no part of the flux.
        let volume = period * period * f64::from(WIDE);
        let flux = (sum.dot(direction) / volume - 0.5 * push) * spacing;
        let apparent = (12.0 * nu * flux / push).cbrt();
        let quantity = format!(
            "surface normal to {:?} lies outside by, cells, flow along {}, τ = {}",
            self.normal,
            if self.along_z { "z" } else { "the slope" },
            self.tau
        );
        let outside = 0.5 * (gap - apparent);
        let trial = tank.trial("plates across the grid");
        Ok(trial.at_most(quantity, outside.abs(), limit))
    }
}
