//! Conservation with blocks in a fluid: momentum, mass, and volume.

use crate::validate::{
    CaseContext, Outcome,
    tank::{self, Tank, block, numbers, turn},
};
use glam::DVec3;
use riprap::scene::{BlockShape, Motion};

const DENSITY: f64 = 2.5;
const STEPS: u64 = 300;

/// Momentum of fluid and blocks in a periodic box, and mass of the fluid: a stream carries along a sphere, a cube and a
/// tetrahedron.
pub fn momentum(context: &CaseContext) -> Outcome {
    let shapes = [
        (BlockShape::Sphere { radius: 4.0 }, [8.3, 8.0, 7.6]),
        (BlockShape::Box { size: [7.0; 3] }, [24.0, 23.5, 8.2]),
        (BlockShape::Tetrahedron { edge: 10.0 }, [8.0, 24.1, 24.0]),
    ];
    let velocities = [[0.02, 0.0, 0.01], [-0.01, 0.02, 0.0], [0.0, -0.01, -0.02]];
    let mut records = Vec::new();
    for tau in [0.52, 1.0] {
        let mut scene = tank::scene([32; 3], tau)?;
        scene.initial.velocity = numbers([0.0, 0.0, 0.02]);
        scene.materials[0].density = DENSITY;
        for ((shape, at), velocity) in shapes.iter().zip(velocities) {
            let mut made = block(shape.clone(), *at, Motion::Free);
            made.velocity = numbers(velocity);
            made.spin = numbers([0.002, -0.001, 0.003]);
            scene.blocks.push(made);
        }
        let mut tank = Tank::fill(context, &scene)?;
        let before = Ledger::of(&mut tank)?;
        tank.advance(STEPS)?;
        let after = Ledger::of(&mut tank)?;
        tank.advance(1)?;
        let last = Ledger::of(&mut tank)?;
        // The populations reflected by cells inside blocks alternate with a period of two steps.
        let lost = 0.5 * (before.less(&after) + before.less(&last));
        let exchanged: f64 = (0..shapes.len())
            .map(|k| (after.blocks[k] - before.blocks[k]).length())
            .sum();
        let trial = tank.trial("three blocks");
        let quantity = format!("momentum lost / exchanged, τ = {tau}");
        records.push(trial.at_most(quantity, lost.length() / exchanged, 1e-2));
        let mass = (after.mass / before.mass - 1.0).abs();
        records.push(trial.at_most("drift of the fluid's mass", mass, 1e-6));
    }
    Ok(records)
}

struct Ledger {
    mass: f64,
    fluid: DVec3,
    /// Without the water inside: it moves with the block and is no load on it, so it counts once, in the fluid.
    blocks: Vec<DVec3>,
}

impl Ledger {
    fn of(tank: &mut Tank<'_>) -> anyhow::Result<Self> {
        let totals = tank.totals()?;
        let blocks = tank.simulation.coupled().map(|c| c.blocks());
        let blocks = blocks.ok_or_else(|| anyhow::anyhow!("the scene has blocks"))?;
        let momentum = |(k, velocity)| blocks.mass(k) * (1.0 - 1.0 / DENSITY) * velocity;
        let velocities = blocks.poses().into_iter().map(|pose| pose.velocity);
        Ok(Self {
            mass: totals.mass,
            fluid: DVec3::from(totals.momentum),
            blocks: velocities.enumerate().map(momentum).collect(),
        })
    }

    /// Total momentum minus that of `other`.
    fn less(&self, other: &Self) -> DVec3 {
        let all = |ledger: &Self| ledger.fluid + ledger.blocks.iter().sum::<DVec3>();
        all(self) - all(other)
    }
}

/// Largest extent of each block, cells.
const ACROSS: f64 = 16.0;
/// Distance between blocks: the diagonal of the cube and a cell on each side.
const SPACING: u32 = 30;
/// Orientations of each shape.
const TURNS: u32 = 4;
const FULL_TURNS: u32 = 16;

/// The solid fractions of the cells of a block add up to its volume: cubes, tetrahedra and icosahedra, rotated and shifted
/// against the grid.
pub fn volume(context: &CaseContext) -> Outcome {
    let tetrahedron = ACROSS;
    // ACROSS is twice the radius of the circumscribed sphere.
    let icosahedron = ACROSS / (10.0 + 2.0 * 5f64.sqrt()).sqrt() * 2.0;
    let shapes = [
        (
            "cubes",
            BlockShape::Box { size: [ACROSS; 3] },
            ACROSS.powi(3),
        ),
        (
            "tetrahedra",
            BlockShape::Tetrahedron { edge: tetrahedron },
            tetrahedron.powi(3) / (6.0 * 2f64.sqrt()),
        ),
        (
            "icosahedra",
            BlockShape::Icosahedron { edge: icosahedron },
            icosahedron.powi(3) * 5.0 / 12.0 * (3.0 + 5f64.sqrt()),
        ),
    ];
    let turns = if context.full { FULL_TURNS } else { TURNS };
    let mut scene = tank::scene(
        [shapes.len() as u32 * SPACING, turns * SPACING, SPACING],
        1.0,
    )?;
    for row in 0..turns {
        for (column, (_, shape, _)) in (0..).zip(&shapes) {
            let number = f64::from(shapes.len() as u32 * row + column);
            let place = |n: u32, step: f64| {
                f64::from(n * SPACING) + 0.5 * f64::from(SPACING) + (step * number).fract()
            };
            let at = [place(column, 0.819), place(row, 0.671), place(0, 0.55)];
            let mut made = block(shape.clone(), at, Motion::Driven);
            made.rotation = turn(row);
            scene.blocks.push(made);
        }
    }
    let mut tank = Tank::fill(context, &scene)?;
    tank.advance(1)?;
    let trial = tank.trial(&format!("{turns} turns"));
    let mut records = Vec::new();
    for (column, (name, _, volume)) in shapes.iter().enumerate() {
        let error = |row: usize| {
            let load = tank.load(shapes.len() * row + column).flow;
            ((load.entrained + load.missing) / volume - 1.0).abs()
        };
        let worst = (0..turns as usize).map(error).fold(0.0, largest);
        records.push(trial.at_most(format!("Σε / volume − 1, {name}"), worst, 1e-4));
    }
    Ok(records)
}

/// The larger value; NaN propagates.
fn largest(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}
