//! The scheme of Geraili Mikola & Sitar (2014) beside the default: the same tanks, errors and run times.

use super::{
    super::{Outcome, Stand},
    buoyancy, dam, still,
};
use riprap::scene::Scheme;

/// Still tank, box under water and dam break with both. Nothing is judged: the default is by its own cases.
pub fn run(stand: &Stand) -> Outcome {
    let mut records = Vec::new();
    for (name, scheme) in [("delta", Scheme::Delta), ("mueller", Scheme::Mueller)] {
        let still = still::measure(stand, 20, scheme)?;
        let trial = &still.trial;
        let of = |what: &str| format!("{name}: {what}");
        records.push(trial.report(of("p at the bottom, Pa"), still.bottom, Some(still::BOTTOM)));
        records.push(trial.report(of("L2(p)"), still.miss, None));
        records.push(trial.report(of("u_rms / √(gH)"), still.speed, None));
        let (trial, [up, across]) = buoyancy::held(stand, (buoyancy::MIDDLE, 0.0), scheme)?;
        records.push(trial.report(of("push on a box / ρVg"), up, Some(1.0)));
        records.push(trial.report(of("push across / ρVg"), across.abs(), None));
        let (trial, [speed, kept]) = dam::front(stand, 20, scheme)?;
        records.push(trial.report(of("dZ/dT of a dam's front"), speed, Some(dam::SPEED)));
        records.push(trial.report(of("share of particles kept"), kept, Some(1.0)));
    }
    Ok(records)
}
