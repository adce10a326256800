//! What the cases share: shapes, all pairs as candidates, running to a time.

use glam::{DQuat, DVec3};
use riprap::{
    Result,
    geometry::{Polyhedron, Shape},
    rock::{
        Block, Blocks, Material, Setup, Snapshot,
        broadphase::{Aabb, Broadphase},
        law::Joint,
    },
};
use std::sync::Arc;

/// Every pair of boxes, looked at.
pub struct AllPairs;

impl Broadphase for AllPairs {
    async fn pairs(&mut self, items: &[Aabb]) -> Result<Vec<[u32; 2]>> {
        let n = items.len();
        let all = (0..n).flat_map(|i| (i + 1..n).map(move |j| [i, j]));
        let near =
            all.filter(|&[i, j]| items[i].group != items[j].group && items[i].overlaps(&items[j]));
        Ok(near.map(|pair| pair.map(|i| i as u32)).collect())
    }
}

pub fn cuboid(x: f64, y: f64, z: f64) -> Arc<Shape> {
    let shape = Polyhedron::cuboid(DVec3::new(x, y, z)).expect("the edges are positive");
    Arc::new(shape.into())
}

/// A rotation about y that turns x downwards by `angle` (rad).
pub fn slope(angle: f64) -> DQuat {
    DQuat::from_rotation_y(angle)
}

/// Joints of one stiffness in both directions, Pa/m, and the friction angle in degrees.
pub fn joint(stiffness: f64, degrees: f64) -> Joint {
    Joint {
        normal_stiffness: stiffness,
        shear_stiffness: stiffness,
        friction_angle: degrees.to_radians(),
        ..Joint::default()
    }
}

pub fn setup(blocks: Vec<Block>, joint: Joint) -> Setup {
    Setup {
        blocks,
        materials: vec![Material {
            density: 2500.0,
            joint,
            elastic: None,
        }],
        ..Setup::default()
    }
}

pub fn blocks(setup: Setup) -> Blocks {
    Blocks::new(setup).expect("the setup is good")
}

pub fn run(blocks: &mut Blocks, until: f64) {
    try_run(blocks, until).expect("no step fails");
}

pub fn try_run(blocks: &mut Blocks, until: f64) -> Result<()> {
    pollster::block_on(blocks.advance(&mut AllPairs, until))
}

/// The state to which `setup` settles in `time` (s) under a mass damping that lets nothing swing: what a
/// slow hand leaves. Another setup of the same blocks may go on from there.
pub fn settled(setup: &Setup, damping: f64, time: f64) -> Snapshot {
    let mut blocks = blocks(Setup {
        damping,
        ..setup.clone()
    });
    run(&mut blocks, time);
    blocks.snapshot()
}
