//! Rows of single kernels: cutting a rock mass, finding pairs, and the step of a block among few others.

use super::{Basis, Bench, Core, Plan, Row, fastest};
use glam::DVec3;
use kit::{
    broadphase::scattered,
    clock::{PATIENCE, Spent, Stopwatch},
    gpu,
};
use riprap::{
    Result,
    geometry::{HalfSpace, Polyhedron, RockMass, Shape},
    rock::{
        Block, Blocks, Material, Setup,
        broadphase::{Broadphase, DeviceBroadphase, HostBroadphase},
    },
};
use std::sync::Arc;

/// Variant of the cut, on all cores.
pub const CUBE: &str = "cube by three joint sets";

/// Cuts a cube by three oblique joint sets of 1 m with scattered spacing, over the numbers of blocks.
pub fn cut(plan: &Plan, rows: &mut Vec<Row>) -> Result<()> {
    for &wanted in &plan.items {
        // Each block has one cubic metre, less at the sides.
        let half = 0.5 * (wanted as f64).cbrt();
        let sides = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| {
            [-axis, axis].map(|normal| HalfSpace {
                normal,
                distance: half,
            })
        });
        let mass = RockMass {
            joints: kit::pile::joint_sets(),
            ..RockMass::new(vec![sides.concat()])
        };
        let mut count = 0;
        let spent = fastest(2, 1, || {
            let watch = Stopwatch::start();
            count = mass.cut()?.blocks.len();
            Ok(watch.spent())
        })?;
        Row::new("cut", CUBE, count, spent, Basis::Wall).push(rows);
    }
    Ok(())
}

/// Measures both broadphases on boxes of one size and of sizes 1:100, over the numbers of boxes.
pub fn broadphase(
    plan: &Plan,
    core: &Core,
    device: Option<&Bench<'_>>,
    rows: &mut Vec<Row>,
) -> Result<()> {
    let finder = device.map(|gpu| DeviceBroadphase::new(gpu.device, gpu.queue));
    let mut on_device = device.zip(finder.transpose()?);
    for ratio in [1u32, 100] {
        for &count in &plan.items {
            let items = scattered(count as u32, f64::from(ratio), count as u64);
            let (mut host, mut gpu) = (Spent::MOST, Spent::MOST);
            // The first round compiles and allocates.
            let mut pairs = pollster::block_on(HostBroadphase.pairs(&items))?.len();
            for _ in 0..=plan.rounds {
                let search = || pollster::block_on(HostBroadphase.pairs(&items)).map(drop);
                host = host.lower(core.time(search)?);
                if let Some((bench, finder)) = &mut on_device {
                    let watch = Stopwatch::start();
                    let found = finder.pairs(&items);
                    let found = gpu::drive(bench.device, PATIENCE, "a search", found)??;
                    gpu = gpu.lower(watch.spent());
                    pairs = pairs.max(found.len());
                }
            }
            let mut push = |by: &str, spent, basis| {
                let variant = format!("{by}, sizes 1:{ratio}");
                let row = Row::new("broadphase", variant, count, spent, basis);
                Row { pairs, ..row }.push(rows);
            };
            push("host", host, Basis::Cpu);
            if let Some((bench, _)) = &on_device {
                let basis = match bench.machine.software {
                    true => Basis::Cpu,
                    false => Basis::Wall,
                };
                push("device", gpu, basis);
            }
        }
    }
    Ok(())
}

/// A variant of the step: one block among five fixed ones.
pub const AMONG_FIVE: &str = "one block among five fixed";
/// Steps between two clock readings.
const TURNS: usize = 500;
/// Centres of walls of 1 m, none of which the block can reach.
const WALLS: [DVec3; 4] = [
    DVec3::new(2.5, 0.0, 0.5),
    DVec3::new(-2.5, 0.0, 0.5),
    DVec3::new(0.0, 2.5, 0.5),
    DVec3::new(0.0, -2.5, 0.5),
];

/// Compares one moving block among five fixed ones with one on a plane: pairs that cannot touch and blocks that do not move
/// should cost nothing. The two are stepped in turns; the ratio is that of the fastest times.
pub fn few_blocks(plan: &Plan, core: &Core, rows: &mut Vec<Row>) -> Result<()> {
    let mut scenes = [block_among(&[])?, block_among(&WALLS)?];
    let looked_at = |blocks: &Blocks| (blocks.counts().pairs, blocks.steps());
    let before = scenes.each_ref().map(looked_at);
    let mut costs = [Spent::MOST; 2];
    for _ in 0..4 * plan.rounds {
        for (blocks, cost) in scenes.iter_mut().zip(&mut costs) {
            let spent = core.time(|| run(blocks, TURNS))?;
            *cost = cost.lower(spent.scaled(1.0 / TURNS as f64));
        }
    }
    for (k, variant) in ["one block on a plane", AMONG_FIVE].into_iter().enumerate() {
        let (pairs, steps) = looked_at(&scenes[k]);
        Row {
            pairs: (pairs - before[k].0).div_ceil(steps - before[k].1) as usize,
            contacts: scenes[k].contacts().count(),
            largest_speed: Some(scenes[k].largest_speed()),
            ratio: Some(costs[k].cpu / costs[0].cpu),
            ..Row::new("step", variant, 1, costs[k], Basis::Cpu)
        }
        .push(rows);
    }
    Ok(())
}

/// A cube of 1 m that has come to rest on a fixed slab, and fixed cubes around it.
fn block_among(walls: &[DVec3]) -> Result<Blocks> {
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
