//! The flow at the time 0.

use crate::{
    Result,
    block::{Form, Part},
    bodies::{Block, Motion, Pose},
    formula::Formula,
    lattice::State,
    scene::{Boundary, Face, Scene},
    units::Units,
};
use glam::DVec3;

/// The initial state in lattice units. Cells of static solids are at rest, and the water inside `blocks` goes with
/// them: it reflects there from step to step, so that another velocity would never die away.
///
/// # Errors
/// If a formula is not finite somewhere.
pub(super) fn start(scene: &Scene, units: &Units, blocks: &[Block]) -> Result<State> {
    let fields = scene.initial_fields()?;
    let excess = |p: &f32| (units.pressure_to_lattice((*p).into()) - 1.0) as f32;
    let speed = |u: &f32| units.velocity_to_lattice((*u).into()) as f32;
    let mut state = State {
        excess: fields.pressure.iter().map(excess).collect(),
        velocity: fields
            .velocity
            .each_ref()
            .map(|u| u.iter().map(speed).collect()),
    };
    for block in blocks {
        let pose = pose(block);
        for part in block.shape.parts() {
            fill(scene, units, &pose, part, &mut state);
        }
    }
    Ok(state)
}

/// Where a block is at the time 0, and how it moves.
fn pose(block: &Block) -> Pose {
    let now = |v: &[Formula; 3]| DVec3::from_array([0, 1, 2].map(|k| v[k].eval_at([0.0; 3], 0.0)));
    let [velocity, spin] = match &block.motion {
        Motion::Free => [block.velocity, block.spin],
        Motion::Fixed => [DVec3::ZERO; 2],
        Motion::Driven { velocity, spin } => [now(velocity), now(spin)],
    };
    Pose::rigid(block.centre, block.rotation.normalize(), velocity, spin)
}

/// Gives the cells whose centres are in a part of a block its velocity.
fn fill(scene: &Scene, units: &Units, pose: &Pose, part: &Part, state: &mut State) {
    let centre = pose.point(part.offset);
    let inside = |x: DVec3| {
        let local = pose.deformation.transpose() * (x - centre);
        match &part.form {
            Form::Sphere { radius } => local.length() <= *radius,
            Form::Convex(shape) => shape.faces().iter().all(|face| face.height(local) <= 0.0),
        }
    };
    let reach = DVec3::splat(part.form.radius());
    let place = |x: DVec3| (x - DVec3::from(scene.domain.origin)) / units.cell - 0.5;
    let (low, high) = (place(centre - reach).ceil(), place(centre + reach).floor());
    // The cells of an axis, each with its place in the domain.
    let cells = scene.cells();
    let along = |axis: usize| {
        let count = i64::from(cells[axis]);
        let periodic = *scene.boundaries.face(Face::ALL[2 * axis]) == Boundary::Periodic;
        (low[axis] as i64..=high[axis] as i64)
            .filter(move |n| periodic || (0..count).contains(n))
            .map(move |n| (n, n.rem_euclid(count) as usize))
    };
    let [nx, ny] = [0, 1].map(|axis| cells[axis] as usize);
    for (z, k) in along(2) {
        for (y, j) in along(1) {
            for (x, i) in along(0) {
                let at = DVec3::new(x as f64, y as f64, z as f64) + 0.5;
                let at = DVec3::from(scene.domain.origin) + units.cell * at;
                if !inside(at) {
                    continue;
                }
                let gradient = pose.deformation_rate * pose.deformation.transpose();
                let velocity = pose.velocity + gradient * (at - pose.centre);
                let cell = i + nx * (j + ny * k);
                for axis in 0..3 {
                    let speed = units.velocity_to_lattice(velocity[axis]);
                    state.velocity[axis][cell] = speed as f32;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::Shape;
    use std::path::Path;

    /// A ball on the edge of a periodic box, in a stream.
    #[test]
    fn water_inside_a_block_moves_with_it() {
        let text = r#"
            domain = { size = [8, 8, 8], cell = 0.5 }
            fluid = { viscosity = 0.1 }
            numerics = { time_step = 0.25 }
            initial = { velocity = [0.2, 0, 0] }
            boundaries = { y_min = { kind = "wall" }, y_max = { kind = "wall" } }
            run = { steps = 1 }
        "#;
        let scene = Scene::from_toml(text, Path::new("."), "stream").unwrap();
        let units = Units::of(&scene).unwrap();
        let centre = DVec3::new(0.1, 7.0, 4.0);
        let ball = Block {
            velocity: DVec3::new(0.0, 0.4, 0.0),
            spin: DVec3::new(0.0, 0.0, 0.1),
            ..Block::new("ball", Shape::sphere(1.9).unwrap(), centre)
        };
        let state = start(&scene, &units, &[ball]).unwrap();
        let mut inside = 0;
        for (cell, x) in scene.domain.centres().enumerate() {
            let mut r = DVec3::from(x) - centre;
            r.x -= 8.0 * (r.x / 8.0).round();
            let expected = if r.length() <= 1.9 {
                inside += 1;
                DVec3::new(-0.1 * r.y, 0.4 + 0.1 * r.x, 0.0)
            } else {
                DVec3::new(0.2, 0.0, 0.0)
            };
            let found = DVec3::from_array([0, 1, 2].map(|a| f64::from(state.velocity[a][cell])));
            // A velocity of 1 m/s is half a cell a step.
            assert!((found - 0.5 * expected).length() < 1e-6, "{x:?}: {found}");
        }
        // The ball's volume in cells, less the cap beyond the wall.
        assert!((180..230).contains(&inside), "{inside}");
    }
}
