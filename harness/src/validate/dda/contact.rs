//! Deformable blocks on each other, on rigid ones, and against each other.

use super::{
    super::rock::{G, Rock, cuboid, joint},
    ROCK, elastic,
};
use crate::validate::{Outcome, Stand};
use glam::DVec3;
use riprap::rock::{
    Block,
    law::{Elastic, Joint},
};

/// Cubes on a rigid floor, of which the second one is rigid: each bears half of itself and what stands on it.
pub fn stack(_: &Stand) -> Outcome {
    let mut list = vec![Block::new("floor", cuboid(9.0, 9.0, 1.0)?, DVec3::Z * -0.5).fixed()];
    for n in 0..4 {
        let at = DVec3::Z * (0.5 + f64::from(n));
        let block = Block::new(format!("{n}"), cuboid(1.0, 1.0, 1.0)?, at);
        list.push(if n == 1 { block } else { block.deformable() });
    }
    let mut setup = elastic(list, joint(1e9, 30.0), ROCK);
    // Near critical for the swinging of the whole stack.
    setup.damping = 300.0;
    let mut rock = Rock::new(setup, "four cubes, the second one rigid, E = 1 GPa")?;
    let start = rock.blocks.ledger();
    rock.run(0.4)?;
    let ledger = rock.blocks.ledger();
    let trial = rock.trial();
    let weight = rock.blocks.mass(1) * G;
    let mut records = Vec::new();
    for (block, above) in [(1, 3.0), (3, 1.0), (4, 0.0)] {
        let stress = rock
            .blocks
            .stress(block)
            .map_or(f64::NAN, |stress| stress.z_axis.z);
        let name = format!("stress of block {block}, Pa");
        // A strain of 1e-4 changes area and height by as much.
        records.push(trial.relative(name, stress, -(above + 0.5) * weight, 1e-3));
    }
    let rigid = rock.blocks.stress(2).is_none();
    records.push(trial.at_least(
        "the rigid one has no stress",
        f64::from(u8::from(rigid)),
        1.0,
    ));
    let error = (ledger.balance() - start.balance()).abs() / ledger.taken();
    records.push(trial.at_most("error of the energy / energy taken", error, 0.01));
    Ok(records)
}

/// Two bars that meet end to end without damping.
pub fn collision(_: &Stand) -> Outcome {
    let bar = |name: &str, x: f64, v: f64| -> anyhow::Result<Block> {
        let block = Block::new(name, cuboid(2.0, 0.5, 0.5)?, DVec3::X * x).deformable();
        Ok(Block {
            velocity: DVec3::X * v,
            ..block
        })
    };
    let joint = Joint {
        damping: 0.0,
        ..joint(1e11, 30.0)
    };
    let rock = Elastic {
        youngs_modulus: 1e10,
        ..ROCK
    };
    let list = vec![bar("left", -1.01, 1.0)?, bar("right", 1.01, 0.0)?];
    let mut setup = elastic(list, joint, rock);
    setup.gravity = DVec3::ZERO;
    let mut rock = Rock::new(setup, "two bars of 2 m at 1 m/s, E = 10 GPa")?;
    let start = rock.blocks.ledger();
    rock.run(0.04)?;
    let end = rock.blocks.ledger();
    let momentum: DVec3 = rock.blocks.poses().iter().map(|pose| pose.velocity).sum();
    let error = (end.balance() - start.balance()).abs() / start.kinetic;
    let trial = rock.trial();
    Ok(vec![
        trial.at_most(
            "error of the momentum / momentum",
            (momentum - DVec3::X).length(),
            1e-12,
        ),
        trial.at_most("error of the energy / energy", error, 0.01),
        trial.report(
            "share that rings on as strain",
            end.strain / start.kinetic,
            None,
        ),
        trial.report(
            "velocity of the second, m/s",
            rock.blocks.poses()[1].velocity.x,
            None,
        ),
    ])
}
