//! The longest stable step, from the shapes, the contacts and the elasticity of the blocks, and the detection of steps so
//! long that blocks could pass through others.

use super::{
    Blocks, Body, body::State, contact_list::ContactSum, deforming::DeformingBlocks,
    narrowphase::Joints, threads::each_block,
};
use crate::{
    Error, Result,
    geometry::{Form, Polyhedron},
    rock::law::{Joint, Stiffness},
};
use glam::{DMat3, DVec3};

/// Assumed share of the surface of a block in contact, before its contacts are known. With the whole surface in contact the
/// step would be √2 too long, which the margin between the usual and the largest step covers.
const HELD_SHARE: f64 = 0.5;

/// ω² and index of the stiffest block, from the faces of the shapes.
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
                // Six spheres around it at an overlap of a tenth of the radius, the limit of penetration:
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

/// ω² and index of the stiffest block, from the contacts and the present deformations.
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

/// ω² and index of the stiffest free block. A contact at X of a deformable block adds at most k(1/m + Xᵀ S⁻¹ X), which
/// its lever represents; the largest eigenvalue of a sum is at most the sum of the largest eigenvalues.
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

/// Calls `each` with the area, centroid and largest extent of each face.
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

/// Largest travel in a step as a share of the width of the block along its velocity: even a thin obstacle then
/// touches it before its middle has passed.
const LARGEST_TRAVEL: f64 = 0.5;

/// Share of its radius by which a block may move without computing its width: half the width of the thinnest block.
const NEGLIGIBLE_TRAVEL: f64 = 2e-4;

impl Blocks {
    /// Returns an error if a block moves too far in a computed step of `dt` (s).
    pub(super) fn check_tunnelling(&self, dt: f64) -> Result<()> {
        let alone = self.bodies.len() < 2 && self.periods.is_none();
        if alone || !self.bodies.iter().any(Body::is_free) {
            // There is no other block, or no free one, to touch.
            return Ok(());
        }
        let all = each_block(&self.bodies, self.bodies.len()).zip(&self.states);
        let all = all.zip(&self.next_states).enumerate();
        let tunnelling = all.filter_map(|(i, ((body, state), next))| {
            let travel = next.centre - state.centre;
            let length = travel.length();
            if length <= NEGLIGIBLE_TRAVEL * body.radius {
                return None;
            }
            let width = width(body, state, &self.deforming, travel / length);
            (length > LARGEST_TRAVEL * width).then_some((i, length, width))
        });
        let Some((block, travel, width)) = tunnelling.min_by_key(|found| found.0) else {
            return Ok(());
        };
        self.check_step_of_shapes(dt)?;
        let message = format!(
            "at {:.3e} m/s it moves {travel:.3e} m in a step of {dt:.3e} s, more than half of the {width:.3e} m that it is \
             wide along its velocity, and could pass through others unseen; take a time_step of at most {:.3e} s, or look \
             at what makes it so fast",
            travel / dt,
            dt * LARGEST_TRAVEL * width / travel
        );
        Err(Error::argument(self.label(block), message))
    }
}

/// Width of a block along a unit vector, m.
fn width(body: &Body, state: &State, deforming: &DeformingBlocks, along: DVec3) -> f64 {
    let deformation = match deforming.of(body) {
        Some((_, strain)) => strain.deformation,
        None => DMat3::from_quat(state.rotation),
    };
    // F X along d is X along Fᵀ d.
    let [low, high] = body.shape.extent(deformation.transpose() * along);
    high - low
}
