//! Cost of solids in the fluid: partially saturated cells, moving blocks, contacts, solid fractions.

mod world;

pub use world::{InterleavedRuns, World, crowd};

use super::{
    Bench,
    target::{Target, show},
};
use glam::{DQuat, DVec3};
use kit::clock::exponent;
use riprap::{
    geometry::{Pose, Shape},
    gpu::kernel::submit_pass,
    lattice::{Lattice, Setup, SolidOperator},
    psm::{Frame, SolidBlock, SolidCells},
    units::Units,
};
use serde::Serialize;
use std::{fmt, sync::Arc};

/// Cells across the spheres of a crowd.
const ACROSS: f64 = 16.0;
/// Solid share of the volume of a crowd.
const SHARE: f64 = 0.1;

/// One measured number.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Kind of record: `solids` or `unused`.
    pub part: &'static str,
    /// Name of the number.
    pub name: String,
    /// Setup of the run.
    pub setup: String,
    /// The number: times are CPU time over the cores on software adapters, else wall time.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{:<40} {:>10.3} {:<4}   {}",
            self.name, self.value, self.unit, self.setup
        )
    }
}

/// The numbers of a part, printed as they come.
pub struct Table {
    part: &'static str,
    /// The numbers so far.
    pub rows: Vec<Row>,
}

impl Table {
    /// Prints the column heads.
    pub fn begin(part: &'static str) -> Self {
        println!("\n{part}\nwhat                                          value unit   of");
        Self {
            part,
            rows: Vec::new(),
        }
    }

    /// Adds a number and returns it.
    pub fn add(&mut self, name: &str, setup: &str, value: f64, unit: &'static str) -> f64 {
        let row = Row {
            part: self.part,
            name: name.into(),
            setup: setup.into(),
            value,
            unit,
        };
        println!("{row}");
        self.rows.push(row);
        value
    }
}

/// Sizes of the measured systems.
struct Plan {
    /// Cells along an edge of the box of the crowds.
    crowd: u32,
    /// The same of the box with one block.
    large: u32,
    /// Diameters of the spheres whose solid fractions are computed, cells.
    voxels: &'static [u32],
}

impl Plan {
    fn new(software: bool, quick: bool, full: bool) -> Self {
        let (crowd, large, voxels): (_, _, &[u32]) = match (software, quick) {
            (true, true) => (64, 64, &[8, 16, 32]),
            (true, false) => (64, if full { 256 } else { 128 }, &[8, 16, 32, 64]),
            (false, _) => (if quick { 96 } else { 192 }, 256, &[16, 32, 64, 128]),
        };
        Self {
            crowd,
            large,
            voxels,
        }
    }
}

/// Measures, and prints a table as it goes.
pub fn measure(bench: &Bench<'_>) -> anyhow::Result<(Vec<Row>, Vec<Target>)> {
    let plan = Plan::new(bench.machine.software, bench.quick, bench.full);
    let (rounds, long) = if bench.quick { (3, 0.1) } else { (7, 0.3) };
    let turns = InterleavedRuns::new(bench, rounds, long);
    let mut table = Table::begin("solids");
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
    table.add("a plain cell", &format!("{n}³"), 1e9 * plain / cells, "ns");
    let touched = worlds[1].touched_cells();
    let more = 1e9 * (still - plain) / touched;
    table.add("a cell in a saturated brick, more", &of, more, "ns");
    let share = touched / cells;
    table.add("cells in saturated bricks", &of, 100.0 * share, "%");
    let of_block = 1e6 * (moving - still) / spheres.len() as f64;
    table.add("a moving block, more", &of, of_block, "µs");
    let fixed = 100.0 * (times.ratio(1, 0) - 1.0);
    table.add("fixed solids, 10 % of the volume, more", &of, fixed, "%");
    let overhead = 100.0 * (times.ratio(2, 0) - 1.0);
    table.add(
        "moving solids, 10 % of the volume, more",
        &of,
        overhead,
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
    table.add("a moving block, more", &of, of_small, "µs");
    drop(worlds);

    // Stacked blocks, and the same without weight, slightly apart.
    let mut worlds = [World::stacks(n, false)?, World::stacks(n, true)?];
    let times = turns.measure(&mut worlds)?;
    let (contacts, sub_steps) = worlds[1].contacts();
    let each = 1e9 * (times.median(1) - times.median(0)) / contacts.max(1.0);
    let of = format!("{n}³, {contacts} contacts, {sub_steps:.1} sub-steps");
    table.add("a contact, all sub-steps of a step", &of, each, "ns");
    drop(worlds);

    let (n, count) = if bench.quick { (64, 125) } else { (128, 1000) };
    let share = f64::from(count) * std::f64::consts::PI / 6.0 * (6.0 / f64::from(n)).powi(3);
    let free = world::crowd(n, 6.0, share);
    let mut world = World::free_spheres(n, 6.0, &free)?;
    let [host, device] = turns.host_and_device(&mut world, 50)?;
    let of = format!("{n}³, {} free spheres, D 6", free.len());
    table.add("a step of many blocks, on the host", &of, 1e3 * host, "ms");
    table.add("the same on the device", &of, 1e3 * device, "ms");
    let host_share = (device > 0.0).then(|| 100.0 * host / device);
    drop(world);

    let n = plan.large;
    let one = [0.5 * f64::from(n) + 0.3; 3];
    let mut worlds = [World::empty(n)?, World::spheres(n, ACROSS, &[one], true)?];
    let times = turns.measure(&mut worlds)?;
    let of = format!("{n}³, D {ACROSS}");
    let single = 100.0 * (times.ratio(1, 0) - 1.0);
    table.add("one moving block, more", &of, single, "%");
    drop(worlds);

    let mut points = Vec::new();
    for &across in plan.voxels {
        let seconds = solid_fractions(&turns, across)?;
        // Cells that the surface crosses, on average 3/2 of its area.
        let surface = 1.5 * std::f64::consts::PI * f64::from(across * across);
        let of = format!("D {across}, {surface:.0} cells of its surface");
        let each = 1e9 * seconds / surface;
        table.add("solid fractions, a surface cell", &of, each, "ns");
        points.push((surface, seconds));
    }
    let power = exponent(&points).unwrap_or(f64::NAN);
    table.add("solid fractions, cost ∝ surfaceᵖ, p", "", power, "");
    // Without the smallest, whose cost is mostly the same for all sizes.
    let last = exponent(&points[1..]).unwrap_or(f64::NAN);
    table.add("the same without the smallest", "", last, "");
    let aims = [
        Target::at_most("moving solids of 10 % ≤ 15 %", Some(overhead), 15.0),
        Target::at_most("one block ≤ 2 %", Some(single), 2.0),
        Target::at_most(
            "host of many free blocks ≤ 10 % of the device",
            host_share,
            10.0,
        ),
        Target::at_most("solid fractions linear, p ≤ 1.1", Some(last), 1.1),
    ];
    Ok((table.rows, show("solids", aims)))
}

/// A frame with cell, step and density of 1.
pub fn unit_frame() -> Frame {
    Frame {
        origin: DVec3::ZERO,
        units: Units {
            cell: 1.0,
            time_step: 1.0,
            density: 1.0,
        },
    }
}

/// Displacement of about a third of a cell, so that all positions within a cell occur.
const STRIDE: f64 = 0.37;

/// Seconds to compute the solid fractions of a moving sphere of `across` cells: tiles, their cells, and the velocity of the solid
/// there.
fn solid_fractions(turns: &InterleavedRuns, across: u32) -> anyhow::Result<f64> {
    let (device, queue) = (&turns.clock.device, &turns.clock.queue);
    let edge = (across + 16).next_multiple_of(16);
    let mut setup = Setup::periodic([edge; 3], 0.03);
    setup.solid_operator = Some(SolidOperator::Holdych);
    let mut lattice = Lattice::new(device, setup)?;
    let shape: Arc<Shape> = Arc::new(Shape::sphere(0.5 * f64::from(across))?);
    let blocks = vec![SolidBlock {
        loaded: false,
        ..SolidBlock::new(shape)
    }];
    let mut cells = SolidCells::new(device, &lattice, unit_frame(), blocks)?;
    let mut place = DVec3::splat(0.5 * f64::from(edge));
    let mut once = |times: u32| -> anyhow::Result<()> {
        for _ in 0..times {
            place += STRIDE * DVec3::new(0.5, 0.3, 0.8);
            let pose = Pose::at_rest(place, DQuat::IDENTITY);
            cells.place(device, queue, &mut lattice, &[pose])?;
            submit_pass(device, queue, |pass| cells.record_cells(pass));
            turns.clock.wait()?;
        }
        Ok(())
    };
    once(4)?;
    let mut seconds = f64::INFINITY;
    const TIMES: u32 = 16;
    for _ in 0..turns.rounds {
        seconds = seconds.min(turns.time(|| once(TIMES))? / f64::from(TIMES));
    }
    Ok(seconds)
}
