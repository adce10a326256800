//! A cube that falls flat on a floor: the parts of both share the damping.

use crate::fixture::{blocks, cuboid, joint, run, setup};
use glam::DVec3;
use kit::assert_near;
use riprap::{
    geometry::{Form, Part, Polyhedron, Shape},
    rock::{Block, Setup},
};
use std::sync::Arc;

const DAMPING: f64 = 0.3;

/// A cube of 1 m of n × n columns.
fn columns(n: usize) -> Arc<Shape> {
    let side = 1.0 / n as f64;
    let place = |i: usize| (i as f64 + 0.5) * side - 0.5;
    let part = |k: usize| Part {
        form: Form::Convex(Polyhedron::cuboid(DVec3::new(side, side, 1.0)).expect("a box")),
        offset: DVec3::new(place(k / n), place(k % n), 0.0),
    };
    let parts = (0..n * n).map(part).collect();
    Arc::new(Shape::compound(parts).expect("columns side by side").0)
}

/// Rebound over the velocity of the impact, without gravity, on a floor of n × n fixed blocks.
fn rebound(cube: Arc<Shape>, n: usize) -> f64 {
    let side = 2.0 / n as f64;
    let place = |i: usize| (i as f64 + 0.5) * side - 1.0;
    let piece = |k: usize| {
        let at = DVec3::new(place(k / n), place(k % n), -0.5);
        Block::new("floor", cuboid(side, side, 1.0), at).fixed()
    };
    let mut falling = Block::new("cube", cube, DVec3::Z * 0.501);
    falling.velocity = -DVec3::Z;
    let mut law = joint(1e8, 30.0);
    law.damping = DAMPING;
    let list = [falling].into_iter().chain((0..n * n).map(piece)).collect();
    let mut blocks = blocks(Setup {
        gravity: DVec3::ZERO,
        time_step: Some(1e-5),
        ..setup(list, law)
    });
    run(&mut blocks, 0.1);
    assert_eq!(blocks.contacts().count(), 0, "it has left");
    blocks.poses()[0].velocity.z
}

#[test]
fn it_does_not_depend_on_the_number_of_parts() {
    let root = (1.0 - DAMPING * DAMPING).sqrt();
    let turned = std::f64::consts::PI - (2.0 * DAMPING * root).atan2(1.0 - 2.0 * DAMPING * DAMPING);
    let exact = (-DAMPING / root * turned).exp();
    let whole = rebound(cuboid(1.0, 1.0, 1.0), 1);
    assert_near(whole / exact, 1.0, 5e-3);
    for (parts, pieces) in [(2, 1), (1, 3), (2, 3), (4, 2)] {
        assert_near(rebound(columns(parts), pieces), whole, 1e-6);
    }
}
