//! What stands, stands still: no creep after settling.

use crate::fixture::{blocks, cuboid, joint, run, setup};
use glam::{DQuat, DVec3};
use riprap::{
    geometry::Polyhedron,
    rock::{Block, Blocks, ContactPoint},
};
use std::{f64::consts::PI, sync::Arc};

/// Largest speed of a settled block, m/s.
const STILL: f64 = 1e-6;

fn floor() -> Block {
    Block::new("floor", cuboid(15.0, 15.0, 1.0), DVec3::Z * -0.5).fixed()
}

/// Blocks of 1 m on a floor, with the mass damping (1/s) that damps their slowest mode.
fn settled(list: Vec<Block>, stiffness: f64, damping: f64, time: f64) -> Blocks {
    let mut setup = setup(list, joint(stiffness, 35.0));
    (setup.damping, setup.start_overlap) = (damping, 0.05);
    let mut blocks = blocks(setup);
    run(&mut blocks, time);
    blocks
}

/// The ledger has followed the work on the springs from the first touch on; the state knows nothing of
/// the way: ½f_n u_n + f_s²/2k_s A. Where the pressure is as good as even, u_n is that of its centre, and
/// both are the same.
fn assert_elastic(blocks: &Blocks, stiffness: f64) {
    let energy = |contact: ContactPoint| {
        let pressing = contact.force.dot(contact.normal);
        let shear = contact.force - pressing * contact.normal;
        0.5 * (pressing * contact.overlap + shear.length_squared() / (stiffness * contact.area))
    };
    let (followed, state) = (
        blocks.ledger().elastic,
        blocks.contacts().map(energy).sum::<f64>(),
    );
    assert!(
        (followed / state - 1.0).abs() < 0.01,
        "{followed} J, {state} J"
    );
}

fn assert_still(blocks: &Blocks) {
    let speed = blocks.largest_speed();
    assert!(speed < STILL, "{speed} m/s");
    // Every block carries its weight to the last of its speed.
    for (i, force) in blocks.contact_forces().enumerate() {
        if blocks.moves(i) {
            let weight = 9.81 * blocks.mass(i);
            let error = (force - DVec3::Z * weight).length() / weight;
            assert!(error < 1e-5, "{}: {force}", blocks.name(i));
        }
    }
}

#[test]
fn a_crooked_stack_of_ten() {
    let mut list = vec![floor()];
    for i in 0..10 {
        let k = f64::from(i);
        let (x, y) = (0.03 * (1.7 * k).sin(), 0.03 * (2.9 * k).cos());
        let turn = DQuat::from_rotation_z(0.3 * k.sin());
        let block = Block::new(
            format!("{i}"),
            cuboid(1.0, 1.0, 1.0),
            DVec3::new(x, y, 0.5 + k),
        );
        list.push(block.turned(turn));
    }
    // Softer, and the stack would be at the edge of buckling: k I over ten joints against its weight.
    // It sways like a cantilever of EI = k_n I h, ω₁ = 3.52 √(EI/(m h³ 10⁴)) = 6.4 rad/s: damped critically.
    let blocks = settled(list, 1e9, 12.0, 3.5);
    assert_still(&blocks);
    assert_elastic(&blocks, 1e9);
}

#[test]
fn a_pyramid_of_55() {
    let mut list = vec![floor()];
    for row in 0..10u32 {
        for i in 0..10 - row {
            let x = 1.002 * (f64::from(i) + 0.5 * f64::from(row) - 4.5);
            let at = DVec3::new(x, 0.0, 0.5 + f64::from(row));
            list.push(Block::new(format!("{row}.{i}"), cuboid(1.0, 1.0, 1.0), at));
        }
    }
    assert_eq!(list.len(), 56);
    let blocks = settled(list, 1e7, 20.0, 2.0);
    assert_still(&blocks);
    assert_elastic(&blocks, 1e7);
}

#[test]
fn a_masonry_arch() {
    const STONES: u32 = 11;
    let mut list = vec![floor()];
    let step = PI / f64::from(STONES);
    for i in 0..STONES {
        let angles = [step * f64::from(i), step * f64::from(i + 1)];
        let corners: Vec<_> = angles
            .iter()
            .flat_map(|a| [4.0, 5.0].map(|r| (r * a.cos(), r * a.sin())))
            .flat_map(|(x, z)| [-0.5, 0.5].map(|y| DVec3::new(x, y, z)))
            .collect();
        let (stone, at) = Polyhedron::from_vertices(&corners).expect("a voussoir");
        list.push(Block::new(format!("stone {i}"), Arc::new(stone.into()), at));
    }
    assert_still(&settled(list, 1e9, 40.0, 1.5));
}
