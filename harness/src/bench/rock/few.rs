//! One moving block among five fixed ones, beside one on a plane: nothing is to be done for pairs that
//! cannot touch and blocks that do not move.

use super::{
    Plan,
    core::{Core, Cost},
    row::{Basis, Done, Row, push},
};
use crate::bench::report::Machine;
use glam::DVec3;
use riprap::{
    Result,
    geometry::{Polyhedron, Shape},
    rock::{Block, Blocks, Material, Setup, broadphase::HostBroadphase},
};
use std::sync::Arc;

/// Variants of the step.
pub const ON_A_PLANE: &str = "one block on a plane";
/// Variants of the step.
pub const AMONG_FIVE: &str = "one block among five fixed";

/// Steps between two looks at the clock.
const TURNS: usize = 500;

/// Steps of both, in turns; their ratio is that of the fastest.
///
/// # Errors
/// If a step fails.
pub fn measure(plan: &Plan, core: &Core, machine: &Machine, rows: &mut Vec<Row>) -> Result<()> {
    let mut scenes = [scene(&[])?, scene(&WALLS)?];
    let before = scenes
        .each_ref()
        .map(|blocks| (blocks.counts().pairs, blocks.steps()));
    let mut costs = [Cost::NONE; 2];
    for _ in 0..4 * plan.rounds {
        for (blocks, cost) in scenes.iter_mut().zip(&mut costs) {
            let ((), took) = core.time(|| run(blocks, TURNS))?;
            *cost = cost.lower(took.of_each(TURNS));
        }
    }
    for (k, variant) in [ON_A_PLANE, AMONG_FIVE].into_iter().enumerate() {
        let calls = scenes[k].counts().pairs - before[k].0;
        let steps = scenes[k].steps() - before[k].1;
        let done = Done {
            kernel: "step",
            variant: variant.into(),
            count: 1,
            pairs: calls.div_ceil(steps) as usize,
            contacts: scenes[k].contacts().count(),
        };
        let row = Row {
            largest_speed: Some(scenes[k].largest_speed()),
            ratio: Some(costs[k].cpu / costs[0].cpu),
            ..Row::new(machine, done, costs[k], Basis::Cpu)
        };
        push(rows, row);
    }
    Ok(())
}

/// Middles of walls of 1 m, none of which the block can reach.
const WALLS: [DVec3; 4] = [
    DVec3::new(2.5, 0.0, 0.5),
    DVec3::new(-2.5, 0.0, 0.5),
    DVec3::new(0.0, 2.5, 0.5),
    DVec3::new(0.0, -2.5, 0.5),
];

/// A cube of 1 m that has come to rest on a fixed slab, and fixed cubes around it.
fn scene(walls: &[DVec3]) -> Result<Blocks> {
    let cuboid = |edges| -> Result<Arc<Shape>> { Ok(Arc::new(Polyhedron::cuboid(edges)?.into())) };
    let slab = cuboid(DVec3::new(10.0, 10.0, 1.0))?;
    let cube = cuboid(DVec3::ONE)?;
    let mut blocks = vec![
        Block::new("slab", slab, -0.5 * DVec3::Z).fixed(),
        Block::new("cube", cube.clone(), 0.5 * DVec3::Z),
    ];
    let walls = walls.iter().enumerate();
    blocks.extend(walls.map(|(n, at)| Block::new(format!("wall {n}"), cube.clone(), *at).fixed()));
    let mut blocks = Blocks::new(Setup {
        blocks,
        materials: vec![Material::default()],
        damping: 500.0,
        ..Setup::default()
    })?;
    run(&mut blocks, 2 * TURNS)?;
    Ok(blocks)
}

fn run(blocks: &mut Blocks, steps: usize) -> Result<()> {
    let until = blocks.time() + steps as f64 * blocks.time_step();
    pollster::block_on(blocks.advance(&mut HostBroadphase, until))
}
