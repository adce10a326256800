//! What solids in the fluid cost: cells that are partly solid, blocks that move, contacts, solid fractions.

mod row;
mod turns;
mod voxels;
mod world;

pub use row::{HEAD, Row};
pub use turns::Turns;
pub use world::{World, crowd};

use super::{Bench, report::Machine, targets::Target, targets::show};
use kit::exponent::exponent;

/// Cells across the spheres of a crowd.
const ACROSS: f64 = 16.0;
/// Share of the volume that is solid in a crowd.
const SHARE: f64 = 0.1;

/// Sizes of what is measured.
struct Plan {
    /// Cells along an edge of the box of the crowds.
    crowd: u32,
    /// Of the box with one block.
    large: u32,
    /// Diameters of which the solid fractions are computed, cells.
    voxels: &'static [u32],
    /// How often each has its turn, and how long a turn should be, s.
    rounds: usize,
    long: f64,
}

impl Plan {
    fn new(machine: &Machine, quick: bool, full: bool) -> Self {
        let rounds = if quick { 3 } else { 7 };
        let long = if quick { 0.1 } else { 0.3 };
        match (machine.software, quick) {
            (true, true) => Self {
                crowd: 64,
                large: 64,
                voxels: &[8, 16, 32],
                rounds,
                long,
            },
            (true, false) => Self {
                crowd: 64,
                large: if full { 256 } else { 128 },
                voxels: &[8, 16, 32, 64],
                rounds,
                long,
            },
            (false, _) => Self {
                crowd: if quick { 96 } else { 192 },
                large: 256,
                voxels: &[16, 32, 64, 128],
                rounds,
                long,
            },
        }
    }
}

/// Measures, and prints a table as it goes.
///
/// # Errors
/// If the device fails.
pub fn measure(bench: &Bench<'_>) -> anyhow::Result<(Vec<Row>, Vec<Target>)> {
    let Bench {
        device,
        queue,
        machine,
        quick,
        full,
    } = *bench;
    let plan = Plan::new(machine, quick, full);
    let turns = Turns::new(device, queue, machine, plan.rounds, plan.long);
    let mut rows = Vec::new();
    println!("\nsolids\n{}", row::HEAD);
    let mut tell = |name: &str, setup: &str, value: f64, unit: &'static str| {
        let row = Row::new(machine, name, setup, value, unit);
        println!("{row}");
        rows.push(row);
        value
    };
    // Cells and blocks, in turns, so that a busy minute strikes all of them alike.
    let n = plan.crowd;
    let spheres = world::crowd(n, ACROSS, SHARE);
    let mut worlds = [
        World::empty(n)?,
        World::spheres(n, ACROSS, &spheres, false)?,
        World::spheres(n, ACROSS, &spheres, true)?,
    ];
    let times = turns.measure(&mut worlds)?;
    let of = format!("{n}³, {} spheres, D {ACROSS}", spheres.len());
    let cells = f64::from(n).powi(3);
    let [plain, still, moving] = [0, 1, 2].map(|k| times.median(k));
    tell("a plain cell", &format!("{n}³"), 1e9 * plain / cells, "ns");
    let touched = worlds[1].touched_cells();
    let more = 1e9 * (still - plain) / touched;
    tell("a cell in a saturated brick, more", &of, more, "ns");
    let share = touched / cells;
    tell("cells in saturated bricks", &of, 100.0 * share, "%");
    let of_block = 1e6 * (moving - still) / spheres.len() as f64;
    tell("a moving block, more", &of, of_block, "µs");
    let fixed = 100.0 * (times.ratio(1, 0) - 1.0);
    tell("fixed solids, 10 % of the volume, more", &of, fixed, "%");
    let overhead = tell(
        "moving solids, 10 % of the volume, more",
        &of,
        100.0 * (times.ratio(2, 0) - 1.0),
        "%",
    );
    drop(worlds);

    let small = world::crowd(n, 6.0, 0.02);
    let mut worlds = [
        World::spheres(n, 6.0, &small, false)?,
        World::spheres(n, 6.0, &small, true)?,
    ];
    let times = turns.measure(&mut worlds)?;
    let of_small = 1e6 * (times.median(1) - times.median(0)) / small.len() as f64;
    let of = format!("{n}³, {} spheres, D 6", small.len());
    tell("a moving block, more", &of, of_small, "µs");
    drop(worlds);

    // Blocks that stand on each other, and the same without weight, a hair apart.
    let mut worlds = [World::stacks(n, false)?, World::stacks(n, true)?];
    let times = turns.measure(&mut worlds)?;
    let (contacts, sub_steps) = worlds[1].contacts();
    let each = 1e9 * (times.median(1) - times.median(0)) / contacts.max(1.0);
    let of = format!("{n}³, {contacts} contacts, {sub_steps:.1} sub-steps");
    tell("a contact, all sub-steps of a step", &of, each, "ns");
    drop(worlds);

    let n = plan.large;
    let one = [0.5 * f64::from(n) + 0.3; 3];
    let mut worlds = [World::empty(n)?, World::spheres(n, ACROSS, &[one], true)?];
    let times = turns.measure(&mut worlds)?;
    let of = format!("{n}³, D {ACROSS}");
    let whole = 100.0 * (times.ratio(1, 0) - 1.0);
    let single = tell("one moving block, more", &of, whole, "%");
    drop(worlds);

    let mut points = Vec::new();
    for &across in plan.voxels {
        let found = voxels::measure(&turns, across)?;
        let of = format!("D {across}, {:.0} cells of its surface", found.surface);
        let each = 1e9 * found.seconds / found.surface;
        tell("solid fractions, a surface cell", &of, each, "ns");
        points.push((found.surface, found.seconds));
    }
    let power = exponent(&points).unwrap_or(f64::NAN);
    tell("solid fractions, cost ∝ surfaceᵖ, p", "", power, "");
    // Without the smallest, of which most is the same for all sizes.
    let last = exponent(&points[1..]).unwrap_or(f64::NAN);
    tell("the same without the smallest", "", last, "");
    let targets = show(
        "solids",
        vec![
            Target::at_most("moving solids of 10 % ≤ 15 %", overhead, 15.0),
            Target::at_most("one block ≤ 2 %", single, 2.0),
            Target::at_most("solid fractions linear, p ≤ 1.1", last, 1.1),
        ],
    );
    Ok((rows, targets))
}
