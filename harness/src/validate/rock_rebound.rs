//! A block that hits a fixed one and leaves it: the contact damps, and does not pull.

use super::{
    Outcome, Stand,
    rock::{DENSITY, Rock, cuboid, joint, setup},
};
use glam::DVec3;
use riprap::rock::{Block, law::Joint};

const STIFFNESS: f64 = 1e7;

/// exp[−ζ/√(1−ζ²)·(π − atan2(2ζ√(1−ζ²), 1−2ζ²))].
fn exact(zeta: f64) -> f64 {
    let root = (1.0 - zeta * zeta).sqrt();
    let phase = (2.0 * zeta * root).atan2(1.0 - 2.0 * zeta * zeta);
    (-zeta / root * (std::f64::consts::PI - phase)).exp()
}

/// Rebound at four damping ratios, and the ledger.
pub fn run(_: &Stand) -> Outcome {
    let omega = (STIFFNESS / DENSITY).sqrt();
    let mut records = Vec::new();
    for zeta in [0.05, 0.1, 0.2, 0.5] {
        let plate = Block::new("plate", cuboid(3.0, 3.0, 1.0)?, DVec3::Z * -0.5).fixed();
        let mut block = Block::new("block", cuboid(1.0, 1.0, 1.0)?, DVec3::Z * 0.5001);
        block.velocity = -DVec3::Z;
        let joint = Joint {
            damping: zeta,
            ..joint(STIFFNESS, 30.0)
        };
        let mut setup = setup(vec![plate, block], joint);
        setup.gravity = DVec3::ZERO;
        // Where in a step the contact begins and ends moves e by up to ζωΔt of itself.
        setup.time_step = Some(1e-3 / omega);
        let mut rock = Rock::new(setup, format!("ζ = {zeta}, ω Δt = 1e-3"))?;
        let before = rock.blocks.ledger();
        rock.run(0.08)?;
        let after = rock.blocks.ledger();
        let trial = rock.trial();
        let e = rock.blocks.poses()[1].velocity.z;
        records.push(trial.absolute("rebound", e, exact(zeta), 2e-3));
        let error = (after.balance() - before.balance()).abs() / before.kinetic;
        records.push(trial.at_most("error of the energy / energy", error, 0.01));
    }
    Ok(records)
}
