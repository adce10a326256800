//! Cutting a rock mass by joint sets into blocks.

use super::{
    Plan,
    core::{Cost, time_on_all},
    row::{Basis, Done, Row, push},
};
use crate::bench::report::Machine;
use glam::DVec3;
use riprap::{
    Result,
    geometry::{HalfSpace, JointSet, RockMass, Scatter},
};

/// What is cut, on all cores.
pub const CUBE: &str = "cube by three joint sets";

/// A cube by three oblique sets of 1 m with scattered spacing, over the numbers of blocks.
///
/// # Errors
/// If the cutter refuses the mass.
pub fn measure(plan: &Plan, machine: &Machine, rows: &mut Vec<Row>) -> Result<()> {
    for &wanted in &plan.items {
        let mass = mass(wanted);
        let (mut cost, mut count) = (Cost::NONE, 0);
        for _ in 0..2 {
            let (fragments, took) = time_on_all(|| mass.cut())?;
            cost = cost.lower(took);
            count = fragments.blocks.len();
        }
        let done = Done {
            kernel: "cut",
            variant: CUBE.into(),
            count,
            pairs: 0,
            contacts: 0,
        };
        push(rows, Row::new(machine, done, cost, Basis::Wall));
    }
    Ok(())
}

/// At least `count` blocks: each has one cubic metre, and those at the sides less.
fn mass(count: usize) -> RockMass {
    let half = 0.5 * (count as f64).cbrt();
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let sides = axes.into_iter().flat_map(|axis| {
        [-axis, axis].map(|normal| HalfSpace {
            normal,
            distance: half,
        })
    });
    let set = |dip, dip_direction, seed| JointSet {
        dip,
        dip_direction,
        spacing: 1.0,
        scatter: Scatter::Uniform { range: 0.2 },
        origin: DVec3::splat(0.123),
        seed,
        persistence: None,
    };
    RockMass {
        joints: vec![set(8.0, 20.0, 1), set(80.0, 100.0, 2), set(85.0, 195.0, 3)],
        ..RockMass::new(vec![sides.collect()])
    }
}
