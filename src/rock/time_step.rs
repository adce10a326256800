//! The longest stable step, from what the blocks look like, from what they touch, and from their elasticity.

use super::{Body, contact_list::ContactSum, deforming::DeformingBlocks, narrowphase::Joints};
use crate::{
    geometry::{Form, Polyhedron},
    rock::law::{Joint, Stiffness},
};
use glam::{DMat3, DVec3};

/// Share of its surface over which a block is held, before its contacts are known. With all of it the
/// step would be √2 too long, which the room between the usual and the largest step covers.
const HELD_SHARE: f64 = 0.5;

/// ω² of the stiffest block and which it is, from the faces of the shapes.
pub(super) fn of_shapes(
    bodies: &[Body],
    deforming: &DeformingBlocks,
    joints: &Joints,
) -> (f64, usize) {
    let stiffness = |body: &Body| {
        let mut sum = Stiffness::default();
        let partners = (0..joints.materials).map(|other| joints.of(body.material, other));
        let stiff = |joint: &&Joint| joint.normal_stiffness + joint.shear_stiffness;
        let Some(joint) = partners.max_by(|a, b| stiff(a).total_cmp(&stiff(b))) else {
            return sum;
        };
        for part in body.shape.parts() {
            match &part.form {
                Form::Convex(shape) => faces(shape, |area, centre, width| {
                    let turned = deforming.of(body).map(|(_, strain)| strain.deformation);
                    let arm = turned.unwrap_or(DMat3::IDENTITY) * (part.offset + centre);
                    let (arm, width) = deforming.lever(body, arm, width);
                    sum.add(joint, HELD_SHARE * area, arm, width);
                }),
                // Six balls around it at an overlap of a tenth of the radius, where it would be refused:
                // sections of π r²/10 each.
                Form::Sphere { radius } => {
                    let arm = part.offset + DVec3::X * *radius;
                    sum.add(joint, 2.0 * radius * radius, arm, 0.6 * radius);
                }
            }
        }
        sum
    };
    stiffest(bodies, deforming, bodies.iter().map(stiffness))
}

/// ω² of the stiffest block and which it is, from the contacts and the present deformations.
pub(super) fn of_sums(
    bodies: &[Body],
    deforming: &DeformingBlocks,
    contact_sums: &[ContactSum],
) -> (f64, usize) {
    stiffest(
        bodies,
        deforming,
        contact_sums.iter().map(|sum| sum.stiffness),
    )
}

/// A contact at X of a block that deforms adds at most k(1/m + Xᵀ S⁻¹ X), which its lever stands for; the
/// largest eigenvalue of a sum is at most the sum of the largest.
fn stiffest(
    bodies: &[Body],
    deforming: &DeformingBlocks,
    contact_sums: impl Iterator<Item = Stiffness>,
) -> (f64, usize) {
    let free = bodies.iter().zip(contact_sums).enumerate();
    free.filter(|(_, (body, _))| body.is_free())
        .map(|(i, (body, sum))| {
            let Some((one, strain)) = deforming.of(body) else {
                let moment = body.inertia.moments.min_element();
                return (sum.frequency_squared(body.mass, moment), i);
            };
            let elastic = one.affine.frequency_squared(strain.deformation);
            let moment = one.affine.smallest_moment();
            (elastic + sum.frequency_squared(body.mass, moment), i)
        })
        .fold(
            (0.0, 0),
            |most, next| if next.0 > most.0 { next } else { most },
        )
}

/// Area, centroid and largest extent of each face.
fn faces(shape: &Polyhedron, mut each: impl FnMut(f64, DVec3, f64)) {
    let vertices = shape.vertices();
    for corners in shape.loops() {
        let at = |k: usize| vertices[corners[k % corners.len()] as usize];
        let origin = at(0);
        let (mut area, mut moment) = (0.0, DVec3::ZERO);
        for k in 1..corners.len() - 1 {
            let (a, b) = (at(k), at(k + 1));
            let part = 0.5 * (a - origin).cross(b - origin).length();
            area += part;
            moment += part / 3.0 * (origin + a + b);
        }
        let extents = (0..corners.len()).flat_map(|i| (0..i).map(move |j| at(i).distance(at(j))));
        each(area, moment / area, extents.fold(0.0, f64::max));
    }
}
