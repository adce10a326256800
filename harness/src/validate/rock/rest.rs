//! Stable structures at rest: a stack of ten, a pyramid of 55, a masonry arch.

use super::{G, Rock, cuboid, floor, joint, setup};
use crate::validate::{CaseContext, Outcome};
use glam::{DQuat, DVec3};
use riprap::{
    geometry::Polyhedron,
    rock::{Block, ContactPoint},
};
use std::{f64::consts::PI, sync::Arc};

const STIFFNESS: f64 = 1e9;
/// Largest speed after settling, m/s.
const STILL: f64 = 1e-6;

/// Lets the blocks settle for `time` s under the mass damping `damping` (1/s), chosen for their slowest mode. `even` is the limit
/// on the error of the elastic energy if the pressure in the joints is uniform.
fn settle(list: Vec<Block>, what: &str, (damping, time): (f64, f64), even: Option<f64>) -> Outcome {
    let mut setup = setup(list, joint(STIFFNESS, 35.0));
    setup.damping = damping;
    let what = format!("{what}, k = {STIFFNESS:.0e} Pa/m, α = {damping} 1/s");
    let mut rock = Rock::new(setup, what)?;
    rock.run(time)?;
    let end = rock.blocks.ledger();
    let off = |(block, force): (usize, DVec3)| {
        let weight = G * rock.blocks.mass(block);
        (force - DVec3::Z * weight).length() / weight
    };
    let forces = rock.blocks.contact_forces().enumerate();
    let free = forces.filter(|(block, _)| rock.blocks.moves(*block));
    let unbalanced = free.map(off).fold(0.0, f64::max);
    let error = rock.energy_error() / end.dissipated();
    // ½f_n u_n + f_s²/2k_s A, independent of the path that the ledger has followed. Both agree if the pressure is uniform; in the
    // joints of an arch it is not.
    let held = |contact: ContactPoint| {
        let pressing = contact.force.dot(contact.normal);
        let shear = contact.force - pressing * contact.normal;
        0.5 * (pressing * contact.overlap + shear.length_squared() / (STIFFNESS * contact.area))
    };
    let state: f64 = rock.blocks.contacts().map(held).sum();
    let trial = rock.trial();
    let speed = rock.blocks.largest_speed();
    Ok(vec![
        trial.at_most("largest speed, m/s", speed, STILL),
        trial.at_most("largest force out of balance / weight", unbalanced, 1e-5),
        trial.at_most("error of the energy / energy taken", error, 0.01),
        trial.relative("elastic energy by its work, J", end.elastic, state, even),
    ])
}

/// Ten cubes in a crooked stack.
pub fn stack(_: &CaseContext) -> Outcome {
    let mut list = vec![floor(15.0)?];
    for i in 0..10 {
        let k = f64::from(i);
        let (x, y) = (0.03 * (1.7 * k).sin(), 0.03 * (2.9 * k).cos());
        let turn = DQuat::from_rotation_z(0.3 * k.sin());
        let at = DVec3::new(x, y, 0.5 + k);
        list.push(Block::new(format!("{i}"), cuboid(1.0, 1.0, 1.0)?, at).rotated(turn));
    }
    settle(list, "crooked stack of 10", (12.0, 4.0), Some(0.01))
}

/// Ten courses of 10 to 1 cubes.
pub fn pyramid(_: &CaseContext) -> Outcome {
    let mut list = vec![floor(15.0)?];
    for row in 0..10u32 {
        for i in 0..10 - row {
            let x = 1.002 * (f64::from(i) + 0.5 * f64::from(row) - 4.5);
            let at = DVec3::new(x, 0.0, 0.5 + f64::from(row));
            list.push(Block::new(format!("{row}.{i}"), cuboid(1.0, 1.0, 1.0)?, at));
        }
    }
    settle(list, "pyramid of 55", (50.0, 1.5), Some(0.01))
}

/// Fifteen stones between radii of 4 and 5 m.
pub fn arch(_: &CaseContext) -> Outcome {
    const STONES: u32 = 15;
    let mut list = vec![floor(15.0)?];
    let step = PI / f64::from(STONES);
    for i in 0..STONES {
        let angles = [step * f64::from(i), step * f64::from(i + 1)];
        let corners: Vec<_> = angles
            .iter()
            .flat_map(|a| [4.0, 5.0].map(|r| (r * a.cos(), r * a.sin())))
            .flat_map(|(x, z)| [-0.5, 0.5].map(|y| DVec3::new(x, y, z)))
            .collect();
        let (stone, at) = Polyhedron::from_vertices(&corners)?;
        list.push(Block::new(format!("stone {i}"), Arc::new(stone.into()), at));
    }
    settle(list, "arch of 15", (25.0, 2.0), None)
}
