//! From the blocks of a setup to bodies and their state at the start.

use super::{
    Block, Body, Setup,
    body::{Drive, State},
    deforming::DeformingBlocks,
};
use crate::rock::integrate::Principal;
use glam::DVec3;

/// The blocks of a setup that has been checked.
pub(super) fn make(setup: &Setup) -> (Vec<Body>, Vec<State>, DeformingBlocks) {
    let mut bodies: Vec<Body> = Vec::with_capacity(setup.blocks.len());
    let mut states = Vec::with_capacity(setup.blocks.len());
    let mut deforming = DeformingBlocks::default();
    let mut first = 0;
    for (index, block) in setup.blocks.iter().enumerate() {
        let material = &setup.materials[block.material];
        let count = block.shape.parts().len();
        let body = Body {
            name: block.name.clone(),
            mass: material.density * block.shape.volume(),
            inertia: Principal::of(block.shape.inertia()).scaled(material.density),
            shape: block.shape.clone(),
            radius: block.shape.radius(),
            material: block.material as u32,
            deforming: deforming.add(index, block, material),
            drive: Drive::of(block),
            guide: None,
            parts: first..first + count,
        };
        first += count;
        states.push(start(&body, block));
        bodies.push(body);
    }
    for guide in &setup.guides {
        bodies[guide.block].guide = Some(Box::new(guide.axis.normalize()));
    }
    (bodies, states, deforming)
}

fn start(body: &Body, block: &Block) -> State {
    let mut state = State {
        centre: block.centre,
        rotation: block.rotation.normalize(),
        velocity: block.velocity,
        spin: block.spin,
        ..State::default()
    };
    match &body.drive {
        Drive::Forces(_) => {
            let frame = state.rotation * body.inertia.axes;
            state.momentum = frame * ((frame.conjugate() * block.spin) * body.inertia.moments);
        }
        Drive::Nothing => (state.velocity, state.spin) = (DVec3::ZERO, DVec3::ZERO),
        Drive::Formulas(_) => [state.velocity, state.spin] = body.driven_at(0.0),
    }
    state
}

/// A tenth of the mean radius of the parts that move: boxes grow little, and the list lives for many steps.
pub(super) fn usual_skin(bodies: &[Body]) -> f64 {
    let moving = bodies.iter().filter(|body| !body.is_fixed());
    let (mut sum, mut count) = (0.0, 0.0f64);
    for part in moving.flat_map(|body| body.shape.parts()) {
        sum += part.form.radius();
        count += 1.0;
    }
    0.1 * sum / count.max(1.0)
}
