//! What blocks feel in joints that are closed from the start.

use super::{
    Ambient,
    closed::{Rim, Uplift},
    over::{Other, covered, others, press},
    passed_on::{Field, passed_on},
};
use crate::{
    block::{Form, Shape},
    bodies::{Load, Period, Pose},
    contact::Placed,
    immersed::{FaceLoad, corners},
    scene::StartPressure,
};
use glam::DVec3;
use rayon::prelude::*;
use std::sync::Arc;

/// Share of a face that may stick out of the domain, as the rounding of contacts is.
const ROUGH: f64 = 0.1;
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
    /// Which others each of the blocks in the fluid touches then.
    pub closed: Vec<Vec<usize>>,
}

impl Stale {
    /// What is to be added to the loads on the blocks in the fluid, for loads on all faces of those that are followed, in
    /// cells of `cell` m. Two that move share the mean of their rims, or have that of the one that has any; what lies
    /// inside a mass, without a rim, that of those around it.
    pub fn loads(
        &self,
        faces: &[Vec<FaceLoad>],
        poses: &[Pose],
        grid: (f64, &Ambient),
    ) -> Vec<Load> {
        let near = |block: usize| {
            let shape = |n: usize| &*self.shapes[n];
            others(shape, (poses, self.period), block, grid.0)
        };
        let followed = |block: usize| match (faces.get(block), self.closed[block].is_empty()) {
            (Some(faces), false) => (near(block), &faces[..]),
            _ => Default::default(),
        };
        let all: Vec<_> = (0..self.closed.len())
            .into_par_iter()
            .map(followed)
            .collect();
        let rims = all.par_iter().enumerate().map(|(block, (around, faces))| {
            let parts: Vec<&Placed> = around.iter().map(|other| &other.part).collect();
            let weight = grid.1.weight(poses[block].centre);
            let beside = (&parts[..], grid.0, weight);
            let rim = Rim::of(faces, &self.shapes[block], &poses[block], beside);
            rim.map(|rim| rim.pressure())
        });
        let rims: Vec<Option<Uplift>> = rims.collect();
        let beside = all.iter().enumerate().flat_map(|(block, (around, _))| {
            let its = move |other: &&Other| self.closed[block].contains(&other.block);
            let way = move |other: &Other| (block, other.block, other.way);
            around.iter().filter(its).map(way)
        });
        let followed = beside.filter(|(_, other, _)| *other < all.len());
        let beside: Vec<_> = followed.collect();
        let whole = |block: usize| {
            let within = |face: &FaceLoad| face.inside >= (1.0 - ROUGH) * face.face.area;
            !all[block].1.is_empty() && all[block].1.iter().all(within)
        };
        let inside = passed_on(&rims, whole, &beside);
        let load = |(block, (around, faces)): (usize, &(Vec<Other>, &[FaceLoad]))| {
            // Of one that sticks out of the domain nobody knows what is outside.
            match rims[block].is_some() || whole(block) {
                true => self.load(block, (around, faces), poses, (grid.0, [&rims, &inside])),
                false => Load::default(),
            }
        };
        all.par_iter().enumerate().map(load).collect()
    }

    fn load(
        &self,
        block: usize,
        (around, faces): (&[Other], &[FaceLoad]),
        poses: &[Pose],
        (cell, [rims, inside]): (f64, [&[Option<Uplift>]; 2]),
    ) -> Load {
        let mut load = Load::default();
        let (pose, shape) = (&poses[block], &self.shapes[block]);
        let heights = TOUCHES.map(|height| height * cell);
        for face in faces.iter().map(|load| load.face) {
            let part = &shape.parts()[face.part];
            let Form::Convex(form) = &part.form else {
                continue;
            };
            // What of the face was inside the block at the start already, and beside the other one.
            let before = Placed::of(part, &self.start[block]);
            let polygon = corners(form, face.face, part.offset, pose);
            let (polygon, area) = covered(&polygon, face.normal, &before, heights.map(|h| -h));
            let joint = |other: &Other| {
                if !self.closed[block].contains(&other.block) {
                    return Default::default();
                }
                let (now, _) = covered(&polygon, face.normal, &other.part, heights);
                let start = Pose {
                    centre: self.start[other.block].centre + other.way,
                    ..self.start[other.block]
                };
                let parts = self.shapes[other.block].parts().iter();
                let then = parts.map(|part| {
                    let part = Placed::of(part, &start);
                    covered(&now, face.normal, &part, heights)
                });
                then.fold(
                    Default::default(),
                    |a: (Vec<DVec3>, f64), b| if b.1 > a.1 { b } else { a },
                )
            };
            let joints: Vec<_> = around.iter().map(|other| (other, joint(other))).collect();
            let closed: f64 = joints.iter().map(|(_, (_, area))| area).sum();
            // Blocks that overlap do not close it twice.
            let share = (area / closed.max(f64::MIN_POSITIVE)).min(1.0);
            for (other, (joint, _)) in &joints {
                let of = |fields: &[Option<Uplift>]| {
                    let theirs = fields.get(other.block).copied().flatten();
                    let theirs = theirs.map(|uplift| uplift.moved(other.way));
                    let both: Vec<_> = fields[block].into_iter().chain(theirs).collect();
                    (!both.is_empty()).then(|| Uplift::mean(&both))
                };
                let Some(uplift) = of(rims).or_else(|| of(inside)) else {
                    continue;
                };
                press(&mut load, joint, share * face.normal, pose.centre, |x| {
                    // Of the full cells, in whose centres they hold it; what these weigh counts in the load already.
                    let place = x - 0.5 * cell * face.normal;
                    let start = match self.period {
                        Some(period) => period.within(place),
                        None => place,
                    };
                    uplift.at(place) - self.pressure.at(start.to_array())
                });
            }
        }
        load
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        block::Polyhedron,
        immersed::{PlaneFace, plane_faces},
    };
    use glam::DQuat;

    /// On the faces of a cube of 4 m an edge, 10 Pa where they are wet.
    fn loads(cube: &Shape, pose: &Pose, wet: impl Fn(DVec3) -> bool) -> Vec<FaceLoad> {
        let load = |face: PlaneFace| FaceLoad {
            face,
            inside: face.area,
            centre: face.centre,
            foot: face.centre,
            wetted: if wet(face.normal) { face.area } else { 0.0 },
            force: if wet(face.normal) {
                -10.0 * face.area * face.normal
            } else {
                DVec3::ZERO
            },
            ..FaceLoad::default()
        };
        let faces = plane_faces(0, &cube.parts()[0], pose);
        faces.into_iter().map(load).collect()
    }

    /// Three cubes in a row, only the first of which is wet: what its rim has more is in both joints, and nobody's
    /// momentum comes from nowhere.
    #[test]
    fn blocks_without_a_rim_have_the_water_of_those_beside_them() {
        let cube = Shape::from(Polyhedron::cuboid(DVec3::splat(4.0)).unwrap());
        let row = [0.0, 4.0, 8.0].map(|x| {
            let centre = DVec3::new(x, 0.0, 0.0);
            Pose::rigid(centre, DQuat::IDENTITY, DVec3::ZERO, DVec3::ZERO)
        });
        let stale = Stale {
            shapes: [0, 1, 2].map(|_| Arc::new(cube.clone())).to_vec(),
            period: None,
            start: row.to_vec(),
            pressure: StartPressure::Linear {
                zero: 3.0,
                gradient: [0.0; 3],
            },
            closed: vec![vec![1], vec![0, 2], vec![1]],
        };
        let faces = [0, 1, 2].map(|n| loads(&cube, &row[n], |normal| n == 0 && normal.x < 0.5));
        let ambient = Ambient {
            density: 1000.0,
            acceleration: Default::default(),
            gravity: DVec3::ZERO,
            period: None,
        };
        let found = stale.loads(&faces, &row, (0.5, &ambient));
        for (load, push) in found.iter().zip([-112.0, 0.0, 112.0]) {
            assert!(
                (load.force - push * DVec3::X).length() < 1e-9,
                "{push}: {load:?}"
            );
        }
    }

    /// A cube of 4 m an edge on a floor, under 3 Pa at the start and between sides at 10 Pa now: the joint has 7 Pa more
    /// where it is still closed as it was, and nothing where another cube has come to lie on it.
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
            shapes: vec![cube.clone(), Arc::new(floor), cube.clone()],
            period: None,
            start: vec![at(0.0, 2.0), below, at(0.0, 9.0)],
            pressure: StartPressure::Linear {
                zero: 3.0,
                gradient: [0.0; 3],
            },
            closed: vec![vec![1]],
        };
        let ambient = Ambient {
            density: 1000.0,
            acceleration: Default::default(),
            gravity: DVec3::ZERO,
            period: None,
        };
        for (pose, push) in [
            (at(0.0, 2.0), 112.0),
            (at(1.0, 2.0), 84.0),
            (at(0.0, 3.0), 0.0),
        ] {
            let faces = loads(&cube, &pose, |normal| normal.z > -0.5);
            let above = at(pose.centre.x, pose.centre.z + 4.0);
            let load = stale.loads(&[faces], &[pose, below, above], (0.5, &ambient))[0];
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
