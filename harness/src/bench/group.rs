//! Measuring the variants of a group in turns, so that a busy minute strikes all of them alike.

use super::{
    report::{Beside, Machine, Moved, Row},
    roofline::flops_a_step,
    variant::{Group, STREAM_ONLY, Variant},
};
use kit::{
    arithmetic::Arithmetic,
    clock::{Clock, Spent},
    copy::{Copy, METHODS},
    flow::sheared_noise,
    stream_only::StreamOnly,
    subject::Subject,
};
use riprap::{
    Error,
    lattice::{Lattice, bytes_a_step},
};

/// Rows of the group, in its order, printed as they are done.
///
/// # Errors
/// If the device fails.
pub fn measure(
    clock: &mut Clock,
    machine: &Machine,
    group: Group,
    quick: bool,
) -> Result<Vec<Row>, Error> {
    // Seconds of a submission, and how often each variant has its turn.
    let (long, rounds) = if quick { (0.1, 3) } else { (0.25, 5) };
    let copy = Copy::new(&clock.device, group.variants[0].memory.populations)?;
    let mut subjects = Vec::new();
    let mut bytes = Vec::new();
    for variant in &group.variants {
        let (subject, moved) = subject(clock, variant)?;
        subjects.push(subject);
        bytes.push(moved);
    }
    subjects.extend(METHODS.map(|method| Subject::Copying(&copy, method)));
    let arithmetic = Arithmetic::new(&clock.device, &clock.queue)?;
    subjects.push(Subject::Computing(&arithmetic));
    // The first turns compile and clear memory; the next ones tell how many fill the time. An even
    // number, because a lattice steps in pairs.
    let mut turns = Vec::new();
    for subject in &mut subjects {
        clock.run(subject, 2)?;
        let spent = clock.run(subject, 2)?;
        turns.push(
            ((long / spent.wall) as u32)
                .clamp(2, 2048)
                .next_multiple_of(2),
        );
    }
    let mut spent = vec![Vec::new(); subjects.len()];
    for _round in 0..rounds {
        for (n, subject) in subjects.iter_mut().enumerate() {
            spent[n].push(clock.run(subject, turns[n])?);
        }
    }
    let medians: Vec<Spent> = spent.iter().map(|all| median(all)).collect();
    let (steps, others) = medians.split_at(group.variants.len());
    let (copies, computing) = others.split_at(METHODS.len());
    let fastest = copies.iter().map(|s| s.basis).fold(f64::INFINITY, f64::min);
    let beside = Beside {
        copy_bandwidth: copy.traffic() / fastest,
        stream_only: steps[0].basis,
        stream_bytes: bytes[0].bytes,
        arithmetic: arithmetic.flops() / computing[0].basis,
    };
    let rows = group.variants.iter().zip(steps).zip(bytes);
    Ok(rows
        .map(|((variant, step), bytes)| {
            let row = Row::new(machine, variant, group.grid, step, bytes, beside);
            println!("{row}");
            row
        })
        .collect())
}

/// The lattice of a variant in motion, and what a step of it moves and computes.
fn subject(clock: &Clock, variant: &Variant) -> Result<(Subject<'static>, Moved), Error> {
    let mut lattice = Lattice::new(&clock.device, variant.setup.clone())?;
    let state = sheared_noise(&variant.setup)?;
    lattice.start(&clock.device, &clock.queue, &state, true)?;
    let bytes = bytes_a_step(lattice.setup(), lattice.grid(), lattice.geometry());
    let flops = flops_a_step(&lattice);
    Ok(if variant.name == STREAM_ONLY {
        let stream = StreamOnly::new(&clock.device, lattice)?;
        (
            Subject::Streaming(Box::new(stream)),
            Moved { bytes, flops: 0 },
        )
    } else {
        (Subject::Steps(Box::new(lattice)), Moved { bytes, flops })
    })
}

/// The median of each kind of time by itself.
fn median(all: &[Spent]) -> Spent {
    let of = |field: &dyn Fn(&Spent) -> f64| {
        let mut values: Vec<f64> = all.iter().map(field).collect();
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    let timed = all.iter().all(|s| s.device.is_some());
    Spent {
        wall: of(&|s| s.wall),
        device: timed.then(|| of(&|s| s.device.unwrap_or(s.wall))),
        cpu: of(&|s| s.cpu),
        basis: of(&|s| s.basis),
    }
}
