//! A block thrown onto a floor moves as a rigid one the more the stiffer it is.

use super::{
    super::rock::{Rock, cuboid, joint},
    ROCK, elastic,
};
use crate::validate::{Outcome, Stand, Trial};
use glam::{DQuat, DVec3};
use riprap::rock::{Block, law::Elastic};

/// Centroid and rotation 0.2 s after the throw; rigid without a modulus.
fn thrown(young: Option<f64>) -> anyhow::Result<(DVec3, DQuat, Trial)> {
    let floor = Block::new("floor", cuboid(9.0, 9.0, 1.0)?, DVec3::Z * -0.5).fixed();
    let turn = DQuat::from_scaled_axis(DVec3::new(0.3, 0.2, 0.1));
    let mut block = Block::new("thrown", cuboid(1.0, 0.8, 0.6)?, DVec3::Z * 0.55).turned(turn);
    (block.velocity, block.spin) = (DVec3::new(1.0, 0.3, -1.0), DVec3::new(0.5, -1.0, 2.0));
    if young.is_some() {
        block = block.deformable();
    }
    let rock = Elastic {
        youngs_modulus: young.unwrap_or(ROCK.youngs_modulus),
        ..ROCK
    };
    let mut setup = elastic(vec![floor, block], joint(1e8, 30.0), rock);
    (setup.corner_area, setup.largest_overlap) = (0.25, 0.3);
    // What the stiffest needs, so that the step is no part of the difference.
    setup.time_step = Some(4e-6);
    let what = young.map_or("rigid".into(), |young| format!("E = {young:.0e} Pa"));
    let mut rock = Rock::new(setup, what)?;
    rock.run(0.2)?;
    let centre = rock.blocks.poses()[1].centre;
    Ok((centre, rock.blocks.rotation(1), rock.trial()))
}

/// How far off at three moduli: the difference falls with 1/E.
pub fn run(_: &Stand) -> Outcome {
    let (centre, rotation, _) = thrown(None)?;
    let mut records = Vec::new();
    let mut before = None;
    for young in [1e9, 1e10, 1e11] {
        let (at, turned, trial) = thrown(Some(young))?;
        let off = (at - centre).length() + turned.angle_between(rotation);
        records.push(trial.report("way and angle from the rigid one, m + rad", off, None));
        if let Some(before) = before {
            // A tenth by theory; contacts that begin a step earlier or later leave their share.
            records.push(trial.at_most("that / at a tenth of the modulus", off / before, 0.2));
        }
        before = Some(off);
    }
    Ok(records)
}
