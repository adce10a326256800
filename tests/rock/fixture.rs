//! Shared helpers of the cases: blocks, setups, running to a time, restarts.

use glam::DVec3;
pub use kit::rock::{joint, setup, slope};
use riprap::{
    Result,
    formula::Formula,
    geometry::{Polyhedron, Shape},
    rock::{Block, Blocks, Setup, Snapshot, broadphase::HostBroadphase},
};
use std::sync::Arc;

pub fn cuboid(x: f64, y: f64, z: f64) -> Arc<Shape> {
    let shape = Polyhedron::cuboid(DVec3::new(x, y, z)).expect("the edges are positive");
    Arc::new(shape.into())
}

pub fn blocks(setup: Setup) -> Blocks {
    Blocks::new(setup).expect("the setup is good")
}

pub fn run(blocks: &mut Blocks, until: f64) {
    try_run(blocks, until).expect("no step fails");
}

pub fn try_run(blocks: &mut Blocks, until: f64) -> Result<()> {
    pollster::block_on(blocks.advance(&mut HostBroadphase, until))
}

/// A fixed square floor with edges of 9 m, its top at z = 0.
pub fn floor() -> Block {
    Block::new("floor", cuboid(9.0, 9.0, 1.0), DVec3::Z * -0.5).fixed()
}

/// A cube of 1 m, its centre at the height `z` (m).
pub fn cube(name: &str, z: f64) -> Block {
    Block::new(name, cuboid(1.0, 1.0, 1.0), DVec3::Z * z)
}

pub fn formulas(texts: [&str; 3]) -> [Formula; 3] {
    texts.map(|text| text.parse().expect("a formula"))
}

/// Runs to the time `end`, and again from a serialised snapshot of the time `cut`; asserts that all bits are the same.
pub fn assert_restarts(setup: &Setup, cut: f64, end: f64) -> Blocks {
    let mut whole = blocks(setup.clone());
    run(&mut whole, cut);
    let bytes = postcard::to_allocvec(&whole.snapshot()).expect("a snapshot");
    let snapshot: Snapshot = postcard::from_bytes(&bytes).expect("a snapshot");
    run(&mut whole, end);
    let mut resumed = blocks(setup.clone());
    resumed.restore(&snapshot).expect("the same blocks");
    assert_eq!(resumed.snapshot(), snapshot);
    run(&mut resumed, end);
    assert_eq!(resumed.snapshot(), whole.snapshot());
    assert_eq!(resumed.ledger(), whole.ledger());
    whole
}
