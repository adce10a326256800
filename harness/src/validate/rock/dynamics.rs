//! Motions with exact solutions: a rebound, and free rotation.

use super::{DENSITY, Rock, cuboid, joint, setup};
use crate::validate::{CaseContext, Outcome, Trial};
use glam::{DMat3, DQuat, DVec3};
use riprap::rock::{
    Block,
    integrate::{Principal, spin, turn},
    law::Joint,
};
use std::time::Instant;

const STIFFNESS: f64 = 1e7;

/// exp[−ζ/√(1−ζ²)·(π − atan2(2ζ√(1−ζ²), 1−2ζ²))].
fn exact(zeta: f64) -> f64 {
    let root = (1.0 - zeta * zeta).sqrt();
    let phase = (2.0 * zeta * root).atan2(1.0 - 2.0 * zeta * zeta);
    (-zeta / root * (std::f64::consts::PI - phase)).exp()
}

/// A block hits a fixed one and rebounds: the contact damps, but does not pull. Checks the rebound without damping and at four
/// damping ratios, and the energy ledger.
pub fn rebound(_: &CaseContext) -> Outcome {
    let omega = (STIFFNESS / DENSITY).sqrt();
    let mut records = Vec::new();
    for (zeta, limits) in [
        (0.0, [1e-5, 1e-5]),
        (0.05, [2e-3, 1e-3]),
        (0.1, [2e-3, 1e-3]),
        (0.2, [2e-3, 1e-3]),
        (0.5, [2e-3, 1e-3]),
    ] {
        let plate = Block::new("plate", cuboid(3.0, 3.0, 1.0)?, DVec3::Z * -0.5).fixed();
        let mut block = Block::new("block", cuboid(1.0, 1.0, 1.0)?, DVec3::Z * 0.5001);
        block.velocity = -DVec3::Z;
        let joint = Joint {
            damping: zeta,
            ..joint(STIFFNESS, 30.0)
        };
        let mut setup = setup(vec![plate, block], joint);
        setup.gravity = DVec3::ZERO;
        // The time within a step at which the contact begins and ends changes e by up to ζωΔt of itself.
        setup.time_step = Some(1e-3 / omega);
        let mut rock = Rock::new(setup, format!("ζ = {zeta}, ω Δt = 1e-3"))?;
        rock.run(0.08)?;
        let trial = rock.trial();
        let e = rock.blocks.poses()[1].velocity.z;
        records.push(trial.absolute("rebound", e, exact(zeta), limits[0]));
        let error = rock.energy_error() / rock.start.kinetic;
        records.push(trial.at_most("error of the energy / energy", error, limits[1]));
    }
    Ok(records)
}

/// Angular velocity of an asymmetric body with I = (1, 2, 3) kg m² at the start, rad/s.
const START: DVec3 = DVec3::new(0.1, 1.0, 0.05);
/// ω(50 s) in the body frame, from the elliptic functions.
const END: DVec3 = DVec3::new(0.1032592, -0.99966871, 0.05216149);

struct Spun {
    trial: Trial,
    omega: DVec3,
    energy: f64,
    momentum: f64,
}

fn spun(steps: u32, dt: f64) -> Spun {
    let begin = Instant::now();
    let body = Principal::of(DMat3::from_diagonal(DVec3::new(1.0, 2.0, 3.0)));
    let momentum = START * body.moments;
    let energy = |omega: DVec3| 0.5 * omega.dot(momentum);
    let mut rotation = DQuat::IDENTITY;
    let (mut worst, mut off): (f64, f64) = (0.0, 0.0);
    for _ in 0..steps {
        rotation = turn(&body, rotation, momentum, dt);
        let omega = spin(&body, rotation, momentum);
        worst = worst.max((energy(omega) / energy(START) - 1.0).abs());
        let found = rotation * (body.moments * (rotation.conjugate() * omega));
        off = off.max((found - momentum).length());
    }
    Spun {
        trial: Trial::since(begin, format!("h = {dt} s"), 1, steps.into()),
        omega: rotation.conjugate() * spin(&body, rotation, momentum),
        energy: worst,
        momentum: off,
    }
}

/// Free rotation of the asymmetric body: order, bound of the energy over 4·10⁴ steps, angular momentum.
pub fn free_body(_: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    let mut errors = Vec::new();
    for dt in [0.1, 0.05, 0.025] {
        let run = spun((50.0 / dt) as u32, dt);
        let error = (run.omega - END).length();
        records.push(run.trial.report("error of ω(50 s), rad/s", error));
        errors.push(error);
        if errors.len() > 1 {
            let order = (errors[errors.len() - 2] / error).log2();
            records.push(run.trial.absolute("order", order, 2.0, 0.1));
        }
    }
    let (early, late) = (spun(1000, 0.05), spun(40_000, 0.05));
    let growth = late.energy / early.energy;
    let trial = &late.trial;
    records.push(trial.at_most("largest error of the energy / energy", late.energy, 2e-5));
    records.push(trial.absolute("that over 4e4 steps / over 1e3", growth, 1.0, 0.01));
    // Round-off of rotating a vector of length 2 to the body axes and back.
    records.push(trial.at_most("largest |ΔL|, kg m²/s", late.momentum, 1e-14));
    Ok(records)
}
