//! Twin of the penalty force of a body on water inside it, eq. 22 of Geraili Mikola & Sitar (2014), in f64 and SI.

use glam::DVec3;
use riprap::{
    geometry::{HalfSpace, Pose},
    sph::Solid,
};

/// A spring and a damper per unit of mass.
#[derive(Clone, Copy)]
pub struct Spring {
    /// 1/s².
    pub stiffness: f64,
    /// 1/s.
    pub damping: f64,
}

/// Acceleration of water at `x` (m) with the velocity `v` (m/s) by a convex part of the body at `pose`.
pub fn penalty(spring: Spring, pose: &Pose, solid: &Solid, x: DVec3, v: DVec3) -> DVec3 {
    let reference = pose.deformation.transpose() * (x - pose.centre);
    let depth = |face: &HalfSpace| face.distance - face.normal.dot(reference);
    let (depth, normal) = match solid {
        Solid::Sphere { centre, radius } => {
            let from = reference - *centre;
            (radius - from.length(), from.normalize())
        }
        Solid::Faces(faces) => {
            if faces.internal.iter().any(|face| depth(face) < 0.0) {
                return DVec3::ZERO;
            }
            let nearest = faces.exposed.iter();
            let nearest = nearest.min_by(|a, b| depth(a).total_cmp(&depth(b)));
            let Some(face) = nearest else {
                return DVec3::ZERO;
            };
            (depth(face), face.normal)
        }
    };
    if depth <= 0.0 {
        return DVec3::ZERO;
    }
    let n = pose.deformation * normal;
    let approach = (v - pose.point_velocity(reference)).dot(n);
    (spring.stiffness * depth - spring.damping * approach).max(0.0) * n
}
