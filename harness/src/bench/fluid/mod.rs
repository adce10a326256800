//! The fluid part: speed of each variant of the fluid kernel, compared with the limits of memory and arithmetic. The variants of
//! a group are measured in turns, so that load on the machine affects all of them alike.

mod row;
mod variant;

pub use row::{Row, storage};
pub use variant::plain;

use super::{
    Args, Bench, budget,
    target::{Target, show},
};
use kit::{
    clock::{Clock, Spent, Turn},
    copy::{Copy, METHODS},
    subject::{Arithmetic, StreamOnly, Subject, sheared_noise},
};
use riprap::{
    Error,
    lattice::{Lattice, Statistics},
    wgpu,
};
use row::{Ceilings, StepWork};
use variant::{Group, PLAIN, STATISTICS, STREAM_ONLY, Variant};

/// Measures the kernels of the fluid on each grid.
pub fn measure(args: &Args, bench: &Bench<'_>) -> anyhow::Result<(Vec<Row>, Vec<Target>)> {
    let software = bench.machine.software;
    let mut clock = bench.clock();
    let budget = budget(args.memory, software);
    let grids: &[u32] = match (&args.grid[..], args.quick) {
        ([], true) => &[64],
        ([], false) => &[64, 96, 128, 256],
        (given, _) => given,
    };
    let (mut rows, mut judged): (Vec<Row>, Vec<Target>) = (Vec::new(), Vec::new());
    for &grid in grids {
        if let Some(why) = too_slow(args, grid, &rows) {
            println!("\n{grid}³: left out, {why}");
            continue;
        }
        println!("\n{grid}³ cells\n{}", row::HEAD);
        for group in variant::groups(grid, software, args.quick, budget, bench.device) {
            rows.extend(measure_group(&mut clock, group, args.quick)?);
        }
        row::explain(grid, &rows);
        judged.extend(show(&format!("{grid}³"), targets(grid, &rows, software)));
    }
    Ok((rows, judged))
}

/// Returns why a grid of the default list would take too long, from the speed on the previous grids.
fn too_slow(args: &Args, grid: u32, rows: &[Row]) -> Option<String> {
    // A group takes tens of steps: at 0.2 s each, that is seconds.
    const PATIENCE: f64 = 0.2;
    let last = rows.iter().rev().find(|row| row.variant == PLAIN)?;
    let seconds = f64::from(grid).powi(3) / (last.mlups_wall * 1e6);
    (args.grid.is_empty() && seconds > PATIENCE)
        .then(|| format!("a step would take {seconds:.1} s; ask for it by --grid {grid}"))
}

/// Measures a group and returns its rows in its order; prints each row.
fn measure_group(clock: &mut Clock, group: Group, quick: bool) -> Result<Vec<Row>, Error> {
    // Seconds per submission, and number of rounds.
    let (long, rounds) = if quick { (0.1, 3) } else { (0.25, 5) };
    let copy = Copy::new(&clock.device, group.variants[0].memory.populations)?;
    let arithmetic = Arithmetic::new(&clock.device)?;
    let (mut subjects, mut work) = (Vec::new(), Vec::new());
    for variant in &group.variants {
        let (subject, of_step) = subject(clock, variant)?;
        subjects.push(subject);
        work.push(of_step);
    }
    subjects.extend(METHODS.map(|method| Subject::Copying(&copy, method)));
    subjects.push(Subject::Computing(&arithmetic));
    // The first turns compile and clear memory; the next ones determine how many steps fill the time. Their number is even,
    // because a lattice steps in pairs; with statistics it covers whole intervals between samples.
    let mut turns = Vec::new();
    for (n, subject) in subjects.iter_mut().enumerate() {
        let is_sampled = group.variants.get(n).is_some_and(|v| v.name == STATISTICS);
        let whole = if is_sampled { 2 * SAMPLED } else { 2 };
        clock.run(subject, whole)?;
        let wall = clock.run(subject, whole)?.spent.wall;
        let filling = ((long / wall) as u32).clamp(2, 2048);
        turns.push(filling.next_multiple_of(whole));
    }
    let mut spent = vec![Vec::new(); subjects.len()];
    for _round in 0..rounds {
        for (n, subject) in subjects.iter_mut().enumerate() {
            spent[n].push(clock.run(subject, turns[n])?);
        }
    }
    let medians: Vec<Turn> = spent.iter().map(|all| median(all)).collect();
    let (steps, others) = medians.split_at(group.variants.len());
    let (copies, computing) = others.split_at(METHODS.len());
    let fastest = copies.iter().map(|s| s.basis).fold(f64::INFINITY, f64::min);
    let ceilings = Ceilings {
        copy_bandwidth: copy.traffic() / fastest,
        stream_only: steps[0].basis,
        stream_bytes: work[0].bytes,
        arithmetic: arithmetic.flops() / computing[0].basis,
    };
    let rows = group.variants.iter().zip(steps).zip(work);
    let row = |((variant, step), work)| {
        let row = Row::new(variant, group.grid, step, work, ceilings);
        println!("{row}");
        row
    };
    Ok(rows.map(row).collect())
}

/// The lattice of a variant with moving fluid, and the bytes and operations of its step.
fn subject(clock: &Clock, variant: &Variant) -> Result<(Subject<'static>, StepWork), Error> {
    let mut lattice = Lattice::new(&clock.device, variant.setup.clone())?;
    let state = sheared_noise(&variant.setup)?;
    lattice.start(&clock.device, &clock.queue, &state, true)?;
    let work = StepWork::of(&lattice);
    if variant.name == STATISTICS {
        return Ok((sampled(&clock.device, lattice)?, work));
    }
    if variant.name != STREAM_ONLY {
        return Ok((Subject::Steps(Box::new(lattice)), work));
    }
    let stream = StreamOnly::new(&clock.device, lattice)?;
    let work = StepWork { flops: 0, ..work };
    Ok((Subject::Streaming(Box::new(stream)), work))
}

/// Steps from one sample of statistics to the next.
const SAMPLED: u32 = 5;

/// Steps of a lattice with statistics.
fn sampled(device: &wgpu::Device, mut lattice: Lattice) -> Result<Subject<'static>, Error> {
    let device = device.clone();
    let mut statistics = Statistics::new(&device, &mut lattice)?;
    Ok(Subject::Recording(Box::new(move |pass| {
        if lattice.step().is_multiple_of(SAMPLED.into())
            && let Err(error) = statistics.record(&device, &mut lattice, pass)
        {
            eprintln!("no sample is recorded: {error}");
        }
        lattice.record(pass);
    })))
}

/// Median of each kind of time, separately.
fn median(all: &[Turn]) -> Turn {
    let of = |field: &dyn Fn(&Turn) -> f64| super::median(all.iter().map(field).collect());
    let timed = all.iter().all(|turn| turn.device.is_some());
    Turn {
        spent: Spent {
            wall: of(&|turn| turn.spent.wall),
            cpu: of(&|turn| turn.spent.cpu),
        },
        device: timed.then(|| of(&|turn| turn.device.unwrap_or(turn.spent.wall))),
        basis: of(&|turn| turn.basis),
    }
}

fn targets(grid: u32, rows: &[Row], software: bool) -> Vec<Option<Target>> {
    // The adapter's preferred layout comes first.
    let find = |name, storage| {
        let mut same = rows.iter().filter(|r| r.grid == grid);
        same.find(|r| r.variant == name && r.storage == storage)
    };
    // Time of a variant over that of the plain step, both relative to the streaming of their group.
    let longer = |name| {
        let plain: &Row = find(PLAIN, "f32")?;
        Some(plain.ratio_to_stream_only / find(name, "f32")?.ratio_to_stream_only)
    };
    let plain = find(PLAIN, "f32");
    let half = find(PLAIN, "f16");
    let mlups = |row: Option<&Row>| row.map(|r| r.mlups);
    let share = |row: Option<&Row>| row.map(|r| r.share_of_copy);
    let mut all = if software {
        let ratio = plain.map(|r| r.ratio_to_stream_only);
        vec![
            Target::at_least("f32 MRT ≥ 0.8 of streaming", ratio, 0.8),
            Target::at_least("f32 MRT ≥ 40 MLUPS", mlups(plain), 40.0),
            Target::at_least("16-bit MRT ≥ 35 MLUPS", mlups(half), 35.0),
        ]
    } else {
        vec![
            Target::at_least("f32 MRT ≥ 0.8 of the copy", share(plain), 0.8),
            Target::at_least("16-bit MRT ≥ 0.65 of the copy", share(half), 0.65),
        ]
    };
    let guard = longer("mrt, guard");
    let statistics = longer(STATISTICS).zip(longer("mrt, WALE"));
    let model = longer(variant::WALL_MODEL).zip(longer(variant::TWO_WALLS));
    all.extend([
        Target::at_most("MRT ≤ 1.1 BGK", longer("bgk").map(f64::recip), 1.1),
        Target::at_most("WALE ≤ 1.6 of the plain step", longer("mrt, WALE"), 1.6),
        Target::at_most("guard ≤ 1.01 of the plain step", guard, 1.01),
        Target::at_most(
            "wall model ≤ 1.08 of the step with walls on two sides",
            model.map(|(model, walls)| model / walls),
            1.08,
        ),
        Target::at_most(
            "statistics of every fifth state ≤ 1.1 of the step with WALE",
            statistics.map(|(sampled, plain)| sampled / plain),
            1.1,
        ),
    ]);
    all
}
