//! Which faces of a block are in a joint.

use super::Coupled;
use crate::{
    block::{Form, Part},
    bodies::Pose,
    contact::Placed,
    immersed::{area_of, corners},
};
use glam::DVec3;

/// Cells within which another block over a face makes it a joint: with less fluid in it pressure is all that a face
/// feels. The first height finds blocks that touch.
const HEIGHTS: [f64; 4] = [0.25, 1.0, 2.0, 3.0];
/// Share of a face over which the other block must lie: that on which a block stands is beside its other faces, and has
/// their lower edges.
const COVERED: f64 = 0.01;

impl Coupled {
    /// Whether over each plane face of a block, part by part, there is another block, a solid or a wall of the domain
    /// within three cells, over a hundredth of it at least.
    pub fn joints(&self, block: usize) -> Vec<bool> {
        let poses = self.blocks().poses();
        let setup = &self.setup().setup.blocks;
        let cell = self.immersed().frame().units.cell;
        let others = self.others(block, HEIGHTS[HEIGHTS.len() - 1] * cell);
        let parts = setup[block].shape.parts().iter();
        parts
            .flat_map(|part| faces_in_joints(part, &poses[block], &others, cell))
            .collect()
    }

    /// The parts of the other blocks, solids and walls that may be within `far` (m) of a block, next to it where the
    /// domain is periodic.
    pub(super) fn others(&self, block: usize, far: f64) -> Vec<Placed> {
        let poses = self.blocks().poses();
        let setup = &self.setup().setup.blocks;
        let mut others = Vec::new();
        for (other, pose) in poses.iter().enumerate().filter(|(n, _)| *n != block) {
            let near = setup[block].shape.radius() + setup[other].shape.radius() + far;
            let apart = pose.centre - poses[block].centre;
            let period = self.blocks().period();
            let way = period.map_or(DVec3::ZERO, |period| period.nearest(apart));
            if (apart + way).length() <= near {
                let parts = setup[other].shape.parts().iter();
                let image = Pose {
                    centre: pose.centre + way,
                    ..*pose
                };
                others.extend(parts.map(|part| Placed::of(part, &image)));
            }
        }
        others
    }
}

fn faces_in_joints(part: &Part, pose: &Pose, others: &[Placed], cell: f64) -> Vec<bool> {
    let Form::Convex(shape) = &part.form else {
        return Vec::new();
    };
    let own = Placed::of(part, pose);
    let in_joint = |(face, plane): (usize, &crate::block::HalfSpace)| {
        let polygon = corners(shape, face, part.offset, pose);
        let area = |corners: &[DVec3]| area_of(corners).1.length();
        let least = COVERED * area(&polygon);
        let covers = |other: &Placed| {
            HEIGHTS.iter().any(|height| {
                let shifted = polygon.iter().map(|x| x + height * cell * plane.normal);
                area(&other.clipped(shifted.collect())) > least
            })
        };
        others.iter().any(covers)
    };
    own.faces.iter().enumerate().map(in_joint).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::Polyhedron;
    use glam::DQuat;

    #[test]
    fn a_face_is_in_a_joint_where_another_block_is_near_over_it() {
        let cube = |x: f64, y: f64| {
            let pose = Pose::rigid(
                DVec3::new(x, y, 0.0),
                DQuat::IDENTITY,
                DVec3::ZERO,
                DVec3::ZERO,
            );
            let part = Part {
                form: Form::Convex(Polyhedron::cuboid(DVec3::ONE).unwrap()),
                offset: DVec3::ZERO,
            };
            (part, pose)
        };
        let (part, pose) = cube(0.0, 0.0);
        // Half over the face at +x by a gap of 0.2, touching at −x, too far at +y.
        let others = [cube(1.2, 0.5), cube(-1.0, 0.0), cube(0.0, 1.5)];
        let others = others.map(|(part, pose)| Placed::of(&part, &pose));
        let own = Placed::of(&part, &pose);
        let found = faces_in_joints(&part, &pose, &others, 0.1);
        for (face, found) in own.faces.iter().zip(found) {
            assert_eq!(found, face.normal.x.abs() > 0.5, "{}", face.normal);
        }
    }
}
