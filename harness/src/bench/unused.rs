//! Cost of unused features, and scaling of the cost of moving blocks: pairs of scenes, in turns.

use super::{
    Bench,
    solids::{InterleavedRuns, Row, Table, World},
    target::{Target, show},
};
use riprap::{
    formula::Formula,
    scene::{EddyViscosity, SolidOperator},
    simulation::Simulation,
};

/// Cells across the block.
const ACROSS: f64 = 12.0;
/// Cells across each of the blocks that move.
const SMALL: f64 = 7.0;
/// Cells across a negligible block.
const SPECK: f64 = 2.0;
/// Limit on the difference of a pair beyond that of a scene and itself, over a step.
const NOISE: f64 = 0.03;

/// A pair of scenes that should cost the same.
struct Pair {
    name: &'static str,
    plain: World,
    unused: World,
    /// Whether the block of the second scene is expected to sleep.
    sleeps: bool,
}

/// Measures, and prints a table as it goes.
pub fn measure(bench: &Bench<'_>) -> anyhow::Result<(Vec<Row>, Vec<Target>)> {
    let (n, rounds) = match (bench.machine.software, bench.quick) {
        (true, true) => (32, 5),
        (true, false) => (48, 21),
        (false, _) => (192, 21),
    };
    let turns = InterleavedRuns::new(bench, rounds, 0.1);
    let mut table = Table::begin("unused");
    let (mut worst, mut noise) = (0.0f64, None);
    for pair in pairs(n)? {
        let mut worlds = [pair.plain, pair.unused];
        let times = turns.measure(&mut worlds)?;
        let more = times.ratio(1, 0) - 1.0;
        let kernels = match same_kernels(&worlds) {
            true => "the same kernels",
            false => "other kernels",
        };
        table.add(pair.name, &format!("{n}³, {kernels}"), 100.0 * more, "%");
        // The first pair is the scene and itself.
        let noise = *noise.get_or_insert(more.abs());
        worst = worst.max(more - noise);
        if pair.sleeps {
            let said = "so it sleeps: 1, or not: 0";
            table.add(said, "", f64::from(u8::from(worlds[1].sleeps())), "");
        }
    }
    let middle = [0.5 * f64::from(n) + 0.3; 3];
    let mut worlds = [
        World::spheres(n, ACROSS, &[middle], false)?,
        World::with_face_loads(n, ACROSS, middle)?,
    ];
    let times = turns.measure(&mut worlds)?;
    let more = 100.0 * (times.ratio(1, 0) - 1.0);
    table.add(
        "loads of faces, where requested",
        &format!("{n}³"),
        more,
        "%",
    );
    let sizes: &[u32] = match (bench.machine.software, bench.quick) {
        (true, true) => &[40, 48],
        (true, false) => &[40, 56, 80],
        (false, _) => &[96, 192, 384],
    };
    let places: Vec<[f64; 3]> = (0..27)
        .map(|k| [k % 3, k / 3 % 3, k / 9].map(|i| 13.0 * f64::from(i) + 6.3))
        .collect();
    let mut costs = Vec::new();
    for &n in sizes {
        let mut worlds = [
            World::spheres(n, SPECK, &places[..1], false)?,
            World::spheres(n, SMALL, &places, true)?,
        ];
        let times = turns.measure(&mut worlds)?;
        let more = times.median(1) - times.median(0);
        let of = format!("{n}³, D {SMALL}, a step {:.2} ms", 1e3 * times.median(0));
        table.add("27 moving blocks, more", &of, 1e3 * more, "ms");
        costs.push(more);
    }
    let growth = match (costs.first(), costs.last()) {
        (Some(first), Some(last)) => last / first,
        _ => f64::NAN,
    };
    // A smaller cost is as wrong as a larger one, and a cost below zero is invalid.
    let apart = if growth > 0.0 {
        growth.max(growth.recip())
    } else {
        f64::INFINITY
    };
    let cells = sizes.last().zip(sizes.first());
    let cells = cells.map_or(1.0, |(last, first)| f64::from(last / first).powi(3));
    let of = format!("{cells:.0} times the cells");
    table.add(
        "their cost in the largest box over the smallest",
        &of,
        growth,
        "",
    );
    let aims = [
        Target::at_most(
            "what is unused costs ≤ 3 % beyond noise",
            Some(worst),
            NOISE,
        ),
        Target::at_most(
            "moving blocks cost the same in any box, within 1.5",
            Some(apart),
            1.5,
        ),
    ];
    Ok((table.rows, show("unused", aims)))
}

fn pairs(n: u32) -> riprap::Result<Vec<Pair>> {
    let with = |change: fn(&mut World)| -> riprap::Result<World> {
        let mut world = World::empty(n)?;
        change(&mut world);
        Ok(world)
    };
    let pair = |name, unused| -> riprap::Result<Pair> {
        Ok(Pair {
            name,
            plain: World::empty(n)?,
            unused,
            sleeps: false,
        })
    };
    let middle = [0.5 * f64::from(n) + 0.3; 3];
    let none = with(|world| world.scene.numerics.eddy_viscosity = EddyViscosity::None)?;
    let zero = with(|world| world.scene.fluid.acceleration = [0.0; 3].map(Formula::number))?;
    let noble = with(|world| world.scene.numerics.solid_operator = SolidOperator::Noble)?;
    Ok(vec![
        pair("nothing: the scene itself again", World::empty(n)?)?,
        pair("eddy viscosity said to be none", none)?,
        pair("body force said to be zero", zero)?,
        pair("an operator of blocks, and no block", noble)?,
        Pair {
            name: "a block that sleeps, beside a fixed one",
            plain: World::spheres(n, ACROSS, &[middle], false)?,
            unused: World::asleep(n, ACROSS, middle)?,
            sleeps: true,
        },
    ])
}

/// Whether both run the same kernels with the same slots and buffers.
fn same_kernels(worlds: &[World; 2]) -> bool {
    let kernels = |world: &World| {
        let of = |simulation: &Simulation| {
            let lattice = simulation.lattice()?;
            let all = lattice.kernels(false);
            let all = all.map(|(kernel, groups)| {
                let bindings: Vec<_> = kernel.bindings().iter().map(|b| b.name.clone()).collect();
                let (file, slots) = (kernel.file().to_owned(), kernel.slots().to_vec());
                (file, slots, bindings, groups)
            });
            Some(all.collect::<Vec<_>>())
        };
        world.simulation.as_ref().and_then(of)
    };
    kernels(&worlds[0]) == kernels(&worlds[1])
}
