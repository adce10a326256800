//! Which faces of a block are in a joint.

use super::{
    Coupled,
    over::{covered, others},
};
use crate::{
    block::{Form, Part},
    bodies::Pose,
    contact::Placed,
    immersed::{area_of, corners},
};

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
        let setup = &self.setup().setup.blocks;
        let places = (&self.blocks().poses()[..], self.blocks().period());
        let found = others(|n| &*setup[n].shape, places, block, far);
        found.into_iter().map(|other| other.part).collect()
    }
}

fn faces_in_joints(part: &Part, pose: &Pose, others: &[Placed], cell: f64) -> Vec<bool> {
    let Form::Convex(shape) = &part.form else {
        return Vec::new();
    };
    let own = Placed::of(part, pose);
    let in_joint = |(face, plane): (usize, &crate::block::HalfSpace)| {
        let polygon = corners(shape, face, part.offset, pose);
        let least = COVERED * area_of(&polygon).1.length();
        let heights = HEIGHTS.map(|height| height * cell);
        let covers = |other: &Placed| covered(&polygon, plane.normal, other, heights).1 > least;
        others.iter().any(covers)
    };
    own.faces.iter().enumerate().map(in_joint).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::Polyhedron;
    use glam::{DQuat, DVec3};

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
