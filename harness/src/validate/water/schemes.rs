//! The scheme of Geraili Mikola & Sitar (2014) compared with the default: the same tanks, errors and run times.

use super::{buoyancy, dam, still};
use crate::validate::{CaseContext, Outcome};
use riprap::scene::Scheme;

/// Still tank, box under water and dam break with both schemes. Nothing is judged here: the default has its own cases.
pub fn run(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    for (name, scheme) in [("delta", Scheme::Delta), ("mueller", Scheme::Mueller)] {
        let still = still::measure(context, 20, scheme)?;
        let trial = &still.trial;
        let of = |what: &str| format!("{name}: {what}");
        records.push(trial.relative(of("p at the bottom, Pa"), still.bottom, still::BOTTOM, None));
        records.push(trial.report(of("L2(p)"), still.miss));
        records.push(trial.report(of("u_rms / √(gH)"), still.speed));
        let (trial, [up, across]) = buoyancy::held(context, (buoyancy::MIDDLE, 0.0), scheme)?;
        records.push(trial.relative(of("push on a box / ρVg"), up, 1.0, None));
        records.push(trial.report(of("push across / ρVg"), across.abs()));
        let (trial, [speed, kept]) = dam::front(context, 20, scheme)?;
        records.push(trial.relative(of("dZ/dT of a dam's front"), speed, dam::SPEED, None));
        records.push(trial.relative(of("share of particles kept"), kept, 1.0, None));
    }
    Ok(records)
}
