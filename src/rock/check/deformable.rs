//! Blocks that deform are of a kind that can, and what acts on single blocks is there to act.

use crate::{
    Error, Result,
    geometry::Form,
    rock::{Block, Deformable, Motion, Setup, applied_forces::value},
};

/// Speed of a fixed point that rounding may leave, as a share of the speeds it is the sum of.
const SPEED_ROUNDING: f64 = 1e-12;

/// # Errors
/// [`Error::Argument`] at `place` if the block cannot deform.
pub(super) fn check(setup: &Setup, block: &Block, place: &str) -> Result<()> {
    let Some(Deformable {
        initial_stress,
        fixed_points,
    }) = &block.deformable
    else {
        return Ok(());
    };
    let refuse = |message: String| Err(Error::argument(place, message));
    if block.motion != Motion::Free {
        return refuse(
            "a deformable block is moved by forces; make it free and hold it by fixed points, or make it rigid"
                .into(),
        );
    }
    match block.shape.parts() {
        [part] if matches!(part.form, Form::Convex(_)) => {}
        [_] => {
            return refuse(
                "a sphere cannot deform, since its contacts want it round; give a polyhedron, or make it rigid"
                    .into(),
            );
        }
        parts => {
            return refuse(format!(
                "a compound of {} parts cannot deform; give a convex block, or make it rigid",
                parts.len()
            ));
        }
    }
    if setup.materials[block.material].elastic.is_none() {
        return refuse(format!(
            "it is deformable, and its material {} has no elasticity; give it Young's modulus and \
             Poisson's ratio",
            block.material
        ));
    }
    if !initial_stress.is_finite() || *initial_stress != initial_stress.transpose() {
        return refuse(format!(
            "its initial stress {initial_stress} Pa must be finite and symmetric"
        ));
    }
    for (number, fixed) in fixed_points.iter().enumerate() {
        let place = format!("{place}: fixed point {number}");
        if !fixed.point.is_finite() {
            return Err(Error::argument(place, "its place is not finite"));
        }
        if fixed.axes == [false; 3] {
            let message = "it is held along no axis; name one at least, or leave it out";
            return Err(Error::argument(place, message));
        }
        let turning = block.spin.cross(block.rotation * fixed.point);
        let velocity = block.velocity + turning;
        let scale = block.velocity.length() + turning.length();
        let moves = |k: usize| fixed.axes[k] && velocity[k].abs() > SPEED_ROUNDING * scale;
        if (0..3).any(moves) {
            let message = format!(
                "it starts with {velocity} m/s where it is held; let the block start at rest, or about \
                 that point"
            );
            return Err(Error::argument(place, message));
        }
    }
    Ok(())
}

/// # Errors
/// [`Error::Argument`] at `place` if a force acts on a block that no force moves, or is no number at the start.
pub(super) fn check_applied_forces(block: &Block, place: &str) -> Result<()> {
    let acts = !block.point_loads.is_empty() || block.acceleration.is_some();
    if acts && block.motion != Motion::Free {
        let message = "point loads and an acceleration act on free blocks alone, and it is fixed or driven; \
                       make it free, or remove them";
        return Err(Error::argument(place, message));
    }
    for (number, load) in block.point_loads.iter().enumerate() {
        if !load.point.is_finite() || !value(&load.force, 0.0).is_finite() {
            let message = "its place or its force at t = 0 is not finite";
            return Err(Error::argument(
                format!("{place}: point load {number}"),
                message,
            ));
        }
    }
    match &block.acceleration {
        Some(formulas) if !value(formulas, 0.0).is_finite() => Err(Error::argument(
            place,
            "its acceleration at t = 0 is not finite",
        )),
        _ => Ok(()),
    }
}
