//! Free rotation by a symmetric splitting about the principal axes (Dullweber, Leimkuhler & McLachlan
//! 1997; McLachlan 1993): the kinetic energy is Σ L_i²/2I_i, and under each term alone the body turns
//! about that axis at the constant rate L_i/I_i. The angular momentum stays as it is, in the world's
//! axes, whatever the step; the energy stays in a band.

use super::Principal;
use glam::{DQuat, DVec3};

/// Rotation of a body after `dt` (s) of free rotation with the angular momentum `momentum` (kg m²/s,
/// world), `body` its principal frame (kg m²).
pub fn turn(body: &Principal, rotation: DQuat, momentum: DVec3, dt: f64) -> DQuat {
    let mut frame = rotation * body.axes;
    let mut inner = frame.conjugate() * momentum;
    for (axis, share) in [(0, 0.5), (1, 0.5), (2, 1.0), (1, 0.5), (0, 0.5)] {
        let angle = share * dt * inner[axis] / body.moments[axis];
        let mut along = DVec3::ZERO;
        along[axis] = 1.0;
        let step = DQuat::from_axis_angle(along, angle);
        frame *= step;
        inner = step.conjugate() * inner;
    }
    (frame * body.axes.conjugate()).normalize()
}

/// Spin (rad/s, world) of a body with the angular momentum `momentum` (kg m²/s, world).
pub fn spin(body: &Principal, rotation: DQuat, momentum: DVec3) -> DVec3 {
    let frame = rotation * body.axes;
    frame * ((frame.conjugate() * momentum) / body.moments)
}
