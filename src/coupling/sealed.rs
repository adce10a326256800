//! Free water in joints that have no room for its particles.

use super::over::{covered, others, press};
use crate::{
    block::{Form, Shape},
    bodies::{Load, Period, Pose},
    contact::Placed,
    immersed::{area_of, corners},
    particles::Head,
};
use glam::DVec3;
use std::sync::Arc;

/// Heights over a face, in spacings: another block at one of them closes an equal share of it. One layer of water
/// in a joint pushes with a part of its pressure only, and more the wider the joint.
const HEIGHTS: [f64; 4] = [1.125, 1.375, 1.625, 1.875];
/// Where a block that is too thin for these still is found, if it touches.
const THIN: f64 = 0.25;

/// Where blocks are less than a spacing apart no particle of water comes between them, and none pushes; up to two
/// spacings what comes there pushes too little. Water does push: a joint carries the pressure that its rim has, between
/// two levels falling linearly from one to the other, as dam engineers assume for uplift. It is that of the linear field
/// around the two blocks ([`Head`]).
#[derive(Debug)]
pub(crate) struct Sealed {
    shapes: Vec<Arc<Shape>>,
    period: Option<Period>,
    spacing: f64,
}

impl Sealed {
    /// Of blocks of these shapes in water of the spacing `spacing` (m).
    pub fn new(shapes: Vec<Arc<Shape>>, period: Option<Period>, spacing: f64) -> Self {
        Self {
            shapes,
            period,
            spacing,
        }
    }

    /// Adds what the water in closed joints does to the blocks that have water around them.
    pub fn push(&self, poses: &[Pose], heads: &[Option<Head>], loads: &mut [Load]) {
        for (block, load) in loads.iter_mut().enumerate() {
            let Some(own) = heads[block] else {
                continue;
            };
            let far = 2.0 * self.spacing;
            let others = others(|n| &*self.shapes[n], (poses, self.period), block, far);
            if others.is_empty() {
                continue;
            }
            for part in self.shapes[block].parts() {
                let Form::Convex(shape) = &part.form else {
                    continue;
                };
                let placed = Placed::of(part, &poses[block]);
                for (face, plane) in placed.faces.iter().enumerate() {
                    let polygon = corners(shape, face, part.offset, &poses[block]);
                    for height in HEIGHTS {
                        let heights = [THIN, height].map(|height| height * self.spacing);
                        let patches = others.iter().map(|(other, part)| {
                            let patch = covered(&polygon, plane.normal, part, heights);
                            (*other, patch)
                        });
                        let patches: Vec<_> =
                            patches.filter(|(_, (_, area))| *area > 0.0).collect();
                        let closed: f64 = patches.iter().map(|(_, (_, area))| area).sum();
                        // Blocks that overlap do not close it twice.
                        let share = (area_of(&polygon).1.length() / closed).min(1.0);
                        let normal = share / HEIGHTS.len() as f64 * plane.normal;
                        for (other, (corners, _)) in patches {
                            let pressure = |x: DVec3| match heads[other] {
                                Some(other) => 0.5 * (own.at(x) + other.at(x)),
                                None => own.at(x),
                            };
                            press(load, &corners, normal, poses[block].centre, pressure);
                        }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::Polyhedron;
    use glam::DQuat;

    fn at(x: f64, y: f64, z: f64) -> Pose {
        let centre = DVec3::new(x, y, z);
        Pose::rigid(centre, DQuat::IDENTITY, DVec3::ZERO, DVec3::ZERO)
    }

    fn cuboid(x: f64, y: f64, z: f64) -> Arc<Shape> {
        Arc::new(Polyhedron::cuboid(DVec3::new(x, y, z)).unwrap().into())
    }

    /// A dam on its base: uplift between two levels, its moment, and nothing where there is room for water.
    #[test]
    fn uplift_falls_linearly_from_heel_to_toe() {
        let shapes = vec![cuboid(4.0, 1.0, 3.0), cuboid(20.0, 1.0, 1.0)];
        let sealed = Sealed::new(shapes, None, 0.1);
        // 30 kPa at the heel, 10 kPa at the toe.
        let head = Head {
            place: DVec3::ZERO,
            pressure: 20e3,
            gradient: DVec3::X * -5e3,
        };
        let heads = [Some(head), None];
        let torque = 5e3 * 16.0 / 3.0;
        for (gap, share) in [(0.0, 1.0), (0.15, 0.5), (0.19, 0.0)] {
            let mut loads = [Load::default(); 2];
            sealed.push(
                &[at(0.0, 0.0, 1.5 + gap), at(0.0, 0.0, -0.5)],
                &heads,
                &mut loads,
            );
            assert!((loads[0].force - DVec3::Z * 80e3 * share).length() < 1e-6);
            // 5 kPa/m ∫x² dx about the middle, turning it downstream.
            let found = loads[0].torque();
            assert!((found.y.abs() - torque * share).abs() < 1e-6, "{found}");
            assert_eq!(loads[1], Load::default());
        }
    }

    #[test]
    fn half_of_a_face_beyond_an_edge_is_open_and_two_blocks_share_a_joint() {
        let shapes = vec![cuboid(1.0, 1.0, 1.0), cuboid(1.0, 1.0, 1.0)];
        let sealed = Sealed::new(shapes, None, 0.1);
        let even = |pressure: f64| {
            Some(Head {
                pressure,
                ..Head::default()
            })
        };
        let mut loads = [Load::default(); 2];
        let poses = [at(0.0, 0.0, 1.0), at(0.5, 0.0, 0.0)];
        sealed.push(&poses, &[even(1.0), even(3.0)], &mut loads);
        assert!((loads[0].force - DVec3::Z).length() < 1e-12);
        assert!((loads[1].force + DVec3::Z).length() < 1e-12);
    }
}
