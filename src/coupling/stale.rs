//! What blocks feel in joints that are closed from the start.

use super::{
    Ambient,
    closed::Rim,
    over::{covered, others, press},
};
use crate::{
    block::{Form, Shape},
    bodies::{Load, Period, Pose},
    contact::Placed,
    immersed::{FaceLoad, corners},
    scene::StartPressure,
};
use std::sync::Arc;

/// Cells within which a block over a face touches it, so that the cells between them are full.
const TOUCHES: [f64; 2] = [0.0, 2e-3];

/// Where blocks touch from the start on, no fluid comes between them: cells that solids fill reflect what they hold, and
/// so for good push with the pressure of the start. Water in the joint has the pressure of its rim, of which this adds
/// what it has more; where a block slides, on what of its joint it still covers.
#[derive(Debug)]
pub(super) struct Stale {
    pub shapes: Vec<Arc<Shape>>,
    pub period: Option<Period>,
    /// Where the blocks were at the start.
    pub start: Vec<Pose>,
    pub pressure: StartPressure,
    /// Which of the blocks in the fluid touch others then, and are to be followed.
    pub closed: Vec<bool>,
}

impl Stale {
    /// What is to be added to the load of a block, for loads on its `faces`, in cells of `cell` m.
    pub fn load(
        &self,
        block: usize,
        faces: &[FaceLoad],
        poses: &[Pose],
        (cell, ambient): (f64, &Ambient),
    ) -> Load {
        let mut load = Load::default();
        if !self.closed[block] {
            return load;
        }
        let (pose, shape) = (&poses[block], &self.shapes[block]);
        let around = others(|n| &*self.shapes[n], (poses, self.period), block, cell);
        let around: Vec<Placed> = around.into_iter().map(|(_, part)| part).collect();
        let weight = ambient.weight(pose.centre);
        let Some(rim) = Rim::of(faces, shape, pose, (&around, cell, weight)) else {
            return load;
        };
        for face in faces.iter().map(|load| load.face) {
            let part = &shape.parts()[face.part];
            let Form::Convex(form) = &part.form else {
                continue;
            };
            // What of the face was inside the block at the start already.
            let before = Placed::of(part, &self.start[block]);
            let inward = TOUCHES.map(|height| -height * cell);
            let polygon = corners(form, face.face, part.offset, pose);
            let (polygon, _) = covered(&polygon, face.normal, &before, inward);
            for other in &around {
                let heights = TOUCHES.map(|height| height * cell);
                let (joint, _) = covered(&polygon, face.normal, other, heights);
                press(&mut load, &joint, face.normal, pose.centre, |x| {
                    // Of the full cells, in whose centres they hold it; what these weigh counts in the load already.
                    let inside = x - 0.5 * cell * face.normal;
                    rim.pressure(inside) - self.pressure.at(inside.to_array())
                });
            }
        }
        load
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{block::Polyhedron, immersed::PlaneFace};
    use glam::{DQuat, DVec3};

    /// A cube of 4 m an edge on a floor, under 3 Pa at the start and between sides at 10 Pa now: the joint has 7 Pa more
    /// where it is still closed as it was.
    #[test]
    fn the_pressure_of_the_rim_replaces_that_of_the_start() {
        let cuboid = |x, y, z| Shape::from(Polyhedron::cuboid(DVec3::new(x, y, z)).unwrap());
        let (cube, floor) = (Arc::new(cuboid(4.0, 4.0, 4.0)), cuboid(40.0, 40.0, 2.0));
        let at = |x: f64, z: f64| {
            let centre = DVec3::new(x, 0.0, z);
            Pose::rigid(centre, DQuat::IDENTITY, DVec3::ZERO, DVec3::ZERO)
        };
        let below = at(0.0, -1.0);
        let stale = Stale {
            shapes: vec![cube.clone(), Arc::new(floor)],
            period: None,
            start: vec![at(0.0, 2.0), below],
            pressure: StartPressure::Linear {
                zero: 3.0,
                gradient: [0.0; 3],
            },
            closed: vec![true],
        };
        let ambient = Ambient {
            density: 1000.0,
            acceleration: Default::default(),
            gravity: DVec3::ZERO,
        };
        for (pose, push) in [
            (at(0.0, 2.0), 112.0),
            (at(1.0, 2.0), 84.0),
            (at(0.0, 3.0), 0.0),
        ] {
            let Form::Convex(form) = &cube.parts()[0].form else {
                unreachable!()
            };
            let faces = form.faces().iter().enumerate().map(|(n, face)| {
                let dry = face.normal.z < -0.5;
                let normal = face.normal;
                FaceLoad {
                    face: PlaneFace {
                        part: 0,
                        face: n,
                        centre: pose.centre + 2.0 * normal,
                        normal,
                        area: 16.0,
                    },
                    inside: 16.0,
                    centre: pose.centre + 2.0 * normal,
                    wetted: if dry { 0.0 } else { 16.0 },
                    force: if dry { DVec3::ZERO } else { -160.0 * normal },
                    ..FaceLoad::default()
                }
            });
            let faces: Vec<FaceLoad> = faces.collect();
            let load = stale.load(0, &faces, &[pose, below], (0.5, &ambient));
            assert!(
                (load.force - push * DVec3::Z).length() < 1e-9,
                "{push}: {load:?}"
            );
            // About the centroid of the cube: what is left of its joint is off to one side.
            let arm = -0.5 * pose.centre.x;
            assert!((load.torque() - push * arm * DVec3::NEG_Y).length() < 1e-9);
        }
    }
}
