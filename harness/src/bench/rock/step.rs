//! Piles at rest: their contacts, and the step of all of their blocks.

use super::{
    Plan,
    contact::{Film, share_of_programs},
    core::{Core, Cost, time_on_all},
    row::{Basis, Done, Row, push},
    split::Split,
};
use crate::bench::report::Machine;
use kit::pile::Pile;
use riprap::Result;

/// Contacts warm and cold and the step, for each number of blocks.
///
/// # Errors
/// If a step fails.
pub fn measure(plan: &Plan, core: &Core, machine: &Machine, rows: &mut Vec<Row>) -> Result<()> {
    for &count in &plan.piles {
        let mut pile = Pile::settled(count)?;
        let speed = pile.blocks.largest_speed();
        println!(
            "pile of {} free blocks among {}: {speed:.1e} m/s after {} steps, {:.1e} m a step",
            pile.free,
            pile.blocks.len(),
            pile.steps,
            speed * pile.blocks.time_step()
        );
        let mut film = Film::new(&mut pile)?;
        let sorted = film.sorted()?;
        contacts(plan, core, machine, &pile, &film, rows)?;
        steps(plan, core, machine, &mut pile, &film, &sorted, rows)?;
    }
    Ok(())
}

/// The resolver alone.
fn contacts(
    plan: &Plan,
    core: &Core,
    machine: &Machine,
    pile: &Pile,
    film: &Film,
    rows: &mut Vec<Row>,
) -> Result<()> {
    let all: Vec<_> = (0..film.pairs.len()).collect();
    for (variant, cold) in [(WARM, false), (COLD, true)] {
        let resolved = film.measure(core, &all, cold, plan.rounds)?;
        let done = Done {
            kernel: "contact",
            variant: variant.into(),
            count: pile.free,
            pairs: film.pairs.len(),
            contacts: resolved.contacts,
        };
        let row = Row {
            share_of_programs: Some(resolved.share_of_programs),
            largest_speed: Some(pile.blocks.largest_speed()),
            ..Row::new(machine, done, resolved.cost, Basis::Cpu)
        };
        push(rows, row);
    }
    Ok(())
}

/// Variants of the contact.
pub const WARM: &str = "pile at rest, warm";
/// Variants of the contact.
pub const COLD: &str = "pile at rest, cold";
/// Variants of the step.
pub const ONE_CORE: &str = "pile at rest, one core";
/// Variants of the step.
pub const ALL_CORES: &str = "pile at rest, all cores";

/// The whole step, on one core with its split, and on all.
fn steps(
    plan: &Plan,
    core: &Core,
    machine: &Machine,
    pile: &mut Pile,
    film: &Film,
    sorted: &[Vec<usize>; 2],
    rows: &mut Vec<Row>,
) -> Result<()> {
    let (mut one, mut all) = (Cost::NONE, Cost::NONE);
    // Small piles step several times between two looks at the clock.
    let turns = (1000 / pile.free.max(1)).max(1);
    let (mut lists, mut taken) = (0, 0);
    let before = pile.blocks.counts();
    // First all on one core: a step finds in its cache what it has left there, not what another core has.
    for on_one in [true, false] {
        let best = if on_one { &mut one } else { &mut all };
        for _ in 0..plan.rounds {
            let mut spent = Cost::ZERO;
            for _ in 0..turns {
                lists += u32::from(pile.find_pairs()?);
                taken += 1;
                let ((), took) = match on_one {
                    true => core.time(|| pile.blocks.step())?,
                    false => time_on_all(|| pile.blocks.step())?,
                };
                spent = spent.with(took);
            }
            *best = best.lower(spent.of_each(turns));
        }
    }
    let programs = share_of_programs(before, pile.blocks.counts());
    let lists_a_step = f64::from(lists) / f64::from(taken);
    let split = Split::of(core, pile, film, sorted, one.cpu, lists_a_step, plan.rounds)?;
    for (variant, cost, basis, split) in [
        (ONE_CORE, one, Basis::Cpu, Some(split)),
        (ALL_CORES, all, Basis::Wall, None),
    ] {
        let done = Done {
            kernel: "step",
            variant: variant.into(),
            count: pile.free,
            pairs: pile.blocks.candidate_pair_count(),
            contacts: pile.blocks.contacts().count(),
        };
        let row = Row {
            share_of_programs: Some(programs),
            largest_speed: Some(pile.blocks.largest_speed()),
            split,
            ..Row::new(machine, done, cost, basis)
        };
        push(rows, row);
    }
    Ok(())
}
