//! Pressure in a joint under a block at rest while the pressure at its mouth changes: in closed joints, in open joints of a few
//! cells, and in one of twelve cells.
//!
//! A fixed block lies between two basins. Both ends of its joint are mouths, and by symmetry its middle is the closed end of a
//! slot of half the length.

use super::{
    CaseContext, Outcome, Trial,
    tank::{self, Tank, block},
};
use anyhow::Context;
use riprap::{
    formula::Formula,
    lattice::{Setup, SolidOperator},
    scene::{BlockShape, Boundary, Field, Motion},
};
use rustfft::num_complex::Complex;
use std::f64::consts::{PI, TAU};

/// Cells of water before each mouth.
const BASIN: u32 = 6;
/// Cells of the domain along the mouth, where it is periodic.
const WIDE: u32 = 4;
/// Thickness of a block, cells.
const THICK: u32 = 8;
/// Amplitude of the pressure; the density is 1.
const PRESSURE: f64 = 1e-3;
/// Steps over which the pressure rises in a step test: a sudden rise would ring in the basins.
const RAMP: u32 = 20;
/// Periods until the response to a sine is steady.
const SETTLE: u64 = 2;
/// Viscosity of water in closed joints, close to zero.
const NU: f64 = 1e-5;
/// Limit on the relative errors of amplitude, delay and rise time of a closed joint.
const CLOSED_LIMIT: f64 = 0.05;
/// The same limit for an open joint of twelve cells.
const RESOLVED_LIMIT: f64 = 0.03;

/// Runs the case.
pub fn run(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    for joint in closed().into_iter().chain(open()) {
        records.extend(joint.measure(context)?);
    }
    Ok(records)
}

/// Joints of blocks in contact, with the default aperture and with two thirds of it.
fn closed() -> Vec<Joint> {
    let beds = [Bed::Wall, Bed::Block(0.0), Bed::Block(0.5)];
    let both = [(None, 1200.0), (Some(0.03), 3600.0)].map(|(aperture, period)| {
        beds.map(|bed| Joint {
            bed,
            width: 0,
            aperture,
            length: 12,
            nu: NU,
            period,
            limit: Some(CLOSED_LIMIT),
        })
    });
    both.concat()
}

/// Joints twelve times as long as wide, with the friction number a √(ω/ν)/2 = 1 and a sine of 160 steps per cell of width.
fn open() -> Vec<Joint> {
    let beds = [
        (1, Bed::Wall),
        (1, Bed::Block(0.5)),
        (2, Bed::Wall),
        (3, Bed::Wall),
        (3, Bed::Block(0.5)),
        (12, Bed::Wall),
    ];
    let joint = |(width, bed)| {
        let cells = f64::from(width);
        Joint {
            bed,
            width,
            aperture: None,
            length: 12 * width,
            nu: 0.01 * cells,
            period: 160.0 * cells,
            limit: (width == 12).then_some(RESOLVED_LIMIT),
        }
    };
    beds.map(joint).into()
}

/// Bed under the block.
#[derive(Clone, Copy)]
enum Bed {
    Wall,
    /// A block whose surface is this far above a face between cells, in cells.
    Block(f64),
}

/// A joint and the sine at its mouth, in lattice units.
#[derive(Clone, Copy)]
struct Joint {
    bed: Bed,
    /// Opening, cells; 0 for blocks in contact.
    width: u32,
    /// Hydraulic aperture of a closed joint; `None` for the default.
    aperture: Option<f64>,
    /// Distance from a mouth to the middle, cells.
    length: u32,
    nu: f64,
    period: f64,
    limit: Option<f64>,
}

impl Joint {
    fn measure(&self, context: &CaseContext) -> Outcome {
        let slot = self.slot();
        let length = f64::from(self.length - self.inside()) - 0.5;
        let (found, trial) = self.sine(context)?;
        let exact = slot.transfer(Complex::new(0.0, TAU / self.period), length);
        let delay = |ratio: Complex<f64>| -ratio.arg() / TAU;
        let every = (self.period / 128.0).ceil() as u64;
        let rise = self.rise(context, every)?;
        let should = half(predicted(slot, length, every, &rise).into_iter(), every);
        let middle = half(rise.iter().map(|p| p[1]), every);
        let judge = |what: &str, found: f64, exact: f64| {
            trial.relative(format!("{}: {what}", self.name()), found, exact, self.limit)
        };
        Ok(vec![
            judge(
                "amplitude in the middle / near the mouth",
                found.norm(),
                exact.norm(),
            ),
            judge("delay / period", delay(found), delay(exact)),
            judge("steps to half of a step", middle, should),
        ])
    }

    /// Cells from a mouth to where the pressure counts as that at the mouth: at the mouth itself the flow is not that of a slot.
    fn inside(&self) -> u32 {
        self.width.max(1)
    }

    fn name(&self) -> String {
        let bed = match self.bed {
            Bed::Wall => "on a wall".to_owned(),
            Bed::Block(offset) => format!("on a block {offset} off the grid"),
        };
        match (self.width, self.aperture) {
            (0, None) => format!("closed, {bed}"),
            (0, Some(aperture)) => format!("closed, {bed}, aperture {aperture} cells"),
            (width, _) => format!("{width} cells, {bed}"),
        }
    }

    /// The slot that the joint should behave like.
    fn slot(&self) -> Slot {
        if self.width > 0 {
            return Slot::Open {
                width: self.width.into(),
                nu: self.nu,
            };
        }
        let mut setup = Setup::periodic([1; 3], self.nu);
        setup.solid_operator = Some(SolidOperator::Holdych);
        setup.joint_aperture = self.aperture;
        let [one, two] = setup.joint_apertures();
        // Populations reflected by full cells spend a step inside them: each such side stores as much as a sixth of a row.
        let (rows, sides, aperture) = match self.bed {
            Bed::Wall => (1.0, 1.0, one),
            Bed::Block(0.0) => (2.0, 2.0, two),
            Bed::Block(_) => (1.0, 2.0, one),
        };
        Slot::Closed {
            rows,
            holds: rows + sides / 6.0,
            conductance: aperture.powi(3) / (12.0 * self.nu),
        }
    }

    fn fill<'a>(&self, context: &'a CaseContext, pressure: &str) -> anyhow::Result<Tank<'a>> {
        let length = 2 * self.length;
        let lower = match self.bed {
            Bed::Wall => 0.0,
            Bed::Block(offset) => f64::from(THICK) + offset,
        };
        let bottom = lower + f64::from(self.width);
        let height = (bottom.ceil() as u32 + THICK).next_multiple_of(4);
        let cells = [length + 2 * BASIN, WIDE, height];
        let mut scene = tank::scene(cells, 3.0 * self.nu + 0.5)?;
        scene.coupling.joint_aperture = self.aperture;
        let pressure: Formula = pressure.parse()?;
        let held = || Boundary::Pressure {
            pressure: pressure.clone(),
            reflecting: true,
        };
        let faces = &mut scene.boundaries;
        (faces.x_min, faces.x_max) = (held(), held());
        faces.z_min = Boundary::Wall {
            velocity: [0.0; 3],
            roughness: 0.0,
        };
        faces.z_max = Boundary::FreeSlip;
        let [long, wide, high] = [length, WIDE, height].map(f64::from);
        let slab = |from: f64, to: f64| {
            let size = [long, wide, to - from];
            let middle = [0.5 * long + f64::from(BASIN), 0.5 * wide, 0.5 * (from + to)];
            block(BlockShape::Box { size }, middle, Motion::Fixed)
        };
        scene.blocks.push(slab(bottom, high));
        if lower > 0.0 {
            scene.blocks.push(slab(0.0, lower));
        }
        Tank::fill(context, &scene)
    }

    /// Mean pressures across the joint every `every` steps: inside a mouth and in the middle.
    fn sample(&self, tank: &mut Tank<'_>, every: u64, times: u64) -> anyhow::Result<Vec<[f64; 2]>> {
        let [nx, ny, _] = tank.lattice().grid().cells;
        let row = match self.bed {
            Bed::Wall => 0,
            Bed::Block(offset) => THICK + offset as u32,
        };
        let place = |x: u32, z: u32| x + nx * ny * z;
        let rows = self.width.max(1);
        let across = |x: u32| (row..row + rows).map(move |z| place(x, z));
        let near_mouth = across(BASIN + self.inside());
        let cells: Vec<u32> = near_mouth.chain(across(BASIN + self.length)).collect();
        let mut found = Vec::new();
        for _ in 0..times {
            tank.advance(every)?;
            let read = tank.read(&[Field::Pressure], &cells)?;
            let (mouth, middle) = read
                .first()
                .context("no pressure")?
                .values
                .split_at(rows as usize);
            let mean =
                |part: &[f32]| part.iter().map(|&p| f64::from(p)).sum::<f64>() / part.len() as f64;
            found.push([mean(mouth), mean(middle)]);
        }
        Ok(found)
    }

    /// Ratio of the pressure in the middle to that near the mouth, for a sinusoidal pressure.
    fn sine(&self, context: &CaseContext) -> anyhow::Result<(Complex<f64>, Trial)> {
        let Self { period, .. } = *self;
        let omega = TAU / period;
        let text = format!("{PRESSURE}*min(1, t/{period})*sin({omega}*t)");
        let mut tank = self.fill(context, &text)?;
        tank.advance(SETTLE * period as u64)?;
        let begin = tank.simulation.step();
        // A whole number of samples per period.
        let every = (period / 40.0) as u64;
        let found = self.sample(&mut tank, every, 40)?;
        let mut sums = [Complex::from(0.0); 2];
        for (n, pair) in (1..).zip(&found) {
            let t = (begin + every * n) as f64;
            for (sum, p) in sums.iter_mut().zip(pair) {
                *sum += Complex::from_polar(*p, -omega * t);
            }
        }
        Ok((sums[1] / sums[0], tank.trial(&self.name())))
    }

    /// Pressures near the mouth and in the middle after a rise of the pressure.
    fn rise(&self, context: &CaseContext, every: u64) -> anyhow::Result<Vec<[f64; 2]>> {
        let mut tank = self.fill(context, &format!("{PRESSURE}*min(1, t/{RAMP})"))?;
        let times = 1.25 * self.period / every as f64;
        self.sample(&mut tank, every, times as u64)
    }
}

/// Model of the water in a joint.
#[derive(Clone, Copy)]
enum Slot {
    /// Viscous water between plates `width` apart.
    Open { width: f64, nu: f64 },
    /// Rows of cells that store and conduct water.
    Closed {
        rows: f64,
        holds: f64,
        conductance: f64,
    },
}

impl Slot {
    /// Pressure at the closed end over that at the mouth for a time dependence e^{st}: 1/cosh qL of sound with the inertia and
    /// friction of the profile between plates, q² = s²/c² / (1 − tanh Λ/Λ) with Λ = a/2 √(s/ν), or with those of a bed of pores.
    fn transfer(self, s: Complex<f64>, length: f64) -> Complex<f64> {
        let squared = match self {
            Self::Open { width, nu } => {
                let lambda = 0.5 * width * (s / nu).sqrt();
                s * s / (1.0 - lambda.tanh() / lambda)
            }
            Self::Closed {
                rows,
                holds,
                conductance,
            } => s * (s + rows / conductance) * holds / rows,
        };
        let exponent = (3.0 * squared).sqrt() * length;
        match exponent.re > 300.0 {
            true => Complex::from(0.0),
            false => 1.0 / exponent.cosh(),
        }
    }

    /// Pressure at the closed end at the time `t` after the pressure at the mouth becomes 1, by Talbot's contour (Abate & Valkó
    /// 2004).
    fn step(self, t: f64, length: f64) -> f64 {
        const NODES: u32 = 24;
        let r = 2.0 * f64::from(NODES) / (5.0 * t);
        let image = |s: Complex<f64>| self.transfer(s, length) / s;
        let mut sum = 0.5 * (r * t).exp() * image(Complex::from(r)).re;
        for k in 1..NODES {
            let theta = f64::from(k) * PI / f64::from(NODES);
            let cot = 1.0 / theta.tan();
            let s = r * theta * Complex::new(cot, 1.0);
            let sigma = theta + (theta * cot - 1.0) * cot;
            sum += ((s * t).exp() * image(s) * Complex::new(1.0, sigma)).re;
        }
        sum * r / f64::from(NODES)
    }
}

/// Pressures that the slot predicts at its closed end from the pressures at the mouth.
fn predicted(slot: Slot, length: f64, every: u64, found: &[[f64; 2]]) -> Vec<f64> {
    let steps: Vec<f64> = (0..found.len())
        .map(|n| slot.step((n as f64 + 0.5) * every as f64, length))
        .collect();
    let mouth = |n: usize| found[n][0];
    let rise = |n: usize| mouth(n) - n.checked_sub(1).map_or(0.0, mouth);
    (0..found.len())
        .map(|n| (0..=n).map(|k| rise(k) * steps[n - k]).sum())
        .collect()
}

/// Step at which the pressure reaches half of [`PRESSURE`], interpolated.
fn half(values: impl Iterator<Item = f64>, every: u64) -> f64 {
    let (mut before, half) = (0.0, 0.5 * PRESSURE);
    for (n, p) in values.enumerate() {
        if p >= half {
            return every as f64 * (n as f64 + (half - before) / (p - before));
        }
        before = p;
    }
    f64::NAN
}
