//! A cube that falls flat on a floor: the parts of both share the damping.

use crate::fixture::{blocks, cuboid, formulas, joint, run, setup};
use glam::DVec3;
use kit::assert_near;
use riprap::{
    geometry::{Form, Part, Polyhedron, Shape},
    rock::{Block, Motion, Setup},
};
use std::sync::Arc;

const DAMPING: f64 = 0.3;

/// A cube of n × n columns.
fn columns(edge: f64, n: usize) -> Arc<Shape> {
    let side = edge / n as f64;
    let place = |i: usize| (i as f64 + 0.5) * side - 0.5 * edge;
    let part = |k: usize| Part {
        form: Form::Convex(Polyhedron::cuboid(DVec3::new(side, side, edge)).expect("a box")),
        offset: DVec3::new(place(k / n), place(k % n), 0.0),
    };
    let parts = (0..n * n).map(part).collect();
    Arc::new(Shape::compound(parts).expect("columns side by side").0)
}

/// Rebound over the velocity of the impact, without gravity, on a floor of n × n blocks that do not move, fixed or driven. All lengths
/// and times are proportional to the edge of the cube, m.
fn rebound(cube: Arc<Shape>, n: usize, driven: bool, edge: f64) -> f64 {
    let side = 2.0 * edge / n as f64;
    let place = |i: usize| (i as f64 + 0.5) * side - edge;
    let piece = |k: usize| {
        let at = DVec3::new(place(k / n), place(k % n), -0.5 * edge);
        let mut block = Block::new("floor", cuboid(side, side, edge), at).fixed();
        if driven {
            block.motion = Motion::Driven {
                velocity: formulas(["0"; 3]),
                spin: formulas(["0"; 3]),
            };
        }
        block
    };
    let mut falling = Block::new("cube", cube, DVec3::Z * 0.501 * edge);
    falling.velocity = -DVec3::Z;
    let mut law = joint(1e8 / edge, 30.0);
    law.damping = DAMPING;
    let list = [falling].into_iter().chain((0..n * n).map(piece)).collect();
    let mut blocks = blocks(Setup {
        gravity: DVec3::ZERO,
        time_step: Some(1e-5 * edge),
        ..setup(list, law)
    });
    run(&mut blocks, 0.1 * edge);
    assert_eq!(blocks.contacts().count(), 0, "it has left");
    blocks.poses()[0].velocity.z
}

#[test]
fn it_does_not_depend_on_the_number_of_parts() {
    let root = (1.0 - DAMPING * DAMPING).sqrt();
    let turned = std::f64::consts::PI - (2.0 * DAMPING * root).atan2(1.0 - 2.0 * DAMPING * DAMPING);
    let exact = (-DAMPING / root * turned).exp();
    let whole = rebound(cuboid(1.0, 1.0, 1.0), 1, false, 1.0);
    assert_near(whole / exact, 1.0, 5e-3);
    for (parts, pieces) in [(2, 1), (1, 3), (2, 3), (4, 2)] {
        for (driven, edge) in [(false, 1.0), (true, 1.0), (false, 1e-5)] {
            let found = rebound(columns(edge, parts), pieces, driven, edge);
            assert_near(found, whole, 1e-6);
        }
    }
}
