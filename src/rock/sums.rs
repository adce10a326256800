//! What all contacts of a block do to it.

use super::{Body, body::Flight, deforming::DeformingBlocks, narrow::Joints, touches::Touches};
use crate::rock::law::Stiffness;
use glam::DVec3;

/// What the contacts of one block do to it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sum {
    /// N.
    pub force: DVec3,
    /// About its centroid, N m.
    pub torque: DVec3,
    /// Springs that hold it.
    pub stiffness: Stiffness,
}

/// The sums of all blocks, in the order of the contacts.
pub(super) fn of_touches(
    touches: &Touches,
    (bodies, deforming): (&[Body], &DeformingBlocks),
    flights: &[Flight],
    joints: &Joints,
    sums: &mut Vec<Sum>,
) {
    sums.clear();
    sums.resize(flights.len(), Sum::default());
    for touch in touches.iter() {
        let [a, b] = touch.blocks.map(|block| block as usize);
        let joint = joints.of(flights[a].material, flights[b].material);
        let (force, moment) = (touch.force.total(), touch.force.couple());
        let at = touch.pressure_centre;
        for (block, at, force, moment) in
            [(a, at, -force, -moment), (b, at - touch.way, force, moment)]
        {
            let sum = &mut sums[block];
            let arm = at - flights[block].centre;
            sum.force += force;
            sum.torque += arm.cross(force) + moment;
            // Among rigid blocks alone nobody looks into the bodies, which are far away in memory.
            let (arm, width) = match deforming.is_empty() {
                true => (arm, touch.width),
                false => deforming.lever(&bodies[block], arm, touch.width),
            };
            sum.stiffness.add(joint, touch.area, arm, width);
        }
    }
}
