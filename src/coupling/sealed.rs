//! Free water in joints that have no room for its particles.

use super::{
    head::{Head, Sample},
    over::{Other, covered, others, press},
    passed_on::passed_on,
    rim::rim,
};
use crate::{
    block::{Form, Shape},
    bodies::{Load, Period, Pose},
    contact::Placed,
    immersed::{area_of, corners},
    particles::{Scheme, Setup, Side},
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
/// over the rims of all joints of the two blocks ([`Head`]); of blocks that are all in joints it is that of those around.
#[derive(Debug)]
pub(crate) struct Sealed {
    shapes: Vec<Arc<Shape>>,
    /// Blocks whose loads somebody wants.
    loaded: Vec<bool>,
    period: Option<Period>,
    /// m.
    spacing: f64,
    /// Support of the particles, m.
    reach: f64,
    /// ρ g, Pa/m.
    weight: DVec3,
    /// Where nothing varies along y: where the particles are, m.
    row: Option<f64>,
    /// Corners of the domain, infinite where it repeats, m.
    domain: [DVec3; 2],
}

/// The closed joints of blocks at one time.
#[derive(Debug, Default)]
pub(crate) struct Closed {
    joints: Vec<Joint>,
    /// Places on the rims of each block.
    rims: Vec<Vec<Sample>>,
}

/// What of a face another block closes.
#[derive(Debug)]
struct Joint {
    block: usize,
    other: usize,
    /// By how much the other one is moved to be there, m.
    way: DVec3,
    corners: Vec<DVec3>,
    /// Outward normal times the share that is closed.
    normal: DVec3,
}

impl Sealed {
    /// Of blocks of these shapes in such water, for the loads on those that are `asked` about.
    pub fn new(
        shapes: Vec<Arc<Shape>>,
        period: Option<Period>,
        setup: &Setup,
        asked: &[bool],
    ) -> Self {
        // Springs push wherever they are met.
        let walls_have_shells = setup.scheme == Scheme::Delta;
        Self {
            shapes,
            loaded: asked
                .iter()
                .map(|asked| *asked && walls_have_shells)
                .collect(),
            period,
            spacing: setup.spacing,
            reach: 2.0 * setup.smoothing * setup.spacing,
            weight: setup.density * setup.gravity,
            domain: [ends(setup, 0), ends(setup, 1)],
            row: setup.plane.then_some(setup.origin.y + 0.5 * setup.size.y),
        }
    }

    /// The joints that are closed where blocks are at `poses`, of those that are `wet`.
    pub fn closed(&self, poses: &[Pose], wet: &[bool]) -> Closed {
        let mut closed = Closed {
            rims: vec![Vec::new(); poses.len()],
            ..Closed::default()
        };
        for block in (0..poses.len()).filter(|block| self.loaded[*block] && wet[*block]) {
            self.close(&mut closed, poses, block);
        }
        closed
    }

    /// Adds the closed joints of a block.
    fn close(&self, closed: &mut Closed, poses: &[Pose], block: usize) {
        let far = 2.0 * self.spacing;
        let others = others(|n| &*self.shapes[n], (poses, self.period), block, far);
        if others.is_empty() {
            return;
        }
        let parts = self.shapes[block].parts().iter();
        let own: Vec<_> = parts.map(|part| Placed::of(part, &poses[block])).collect();
        let solids = own.iter().chain(others.iter().map(|other| &other.part));
        for (part, placed) in self.shapes[block].parts().iter().zip(&own) {
            let Form::Convex(shape) = &part.form else {
                continue;
            };
            for (face, plane) in placed.faces.iter().enumerate() {
                let polygon = corners(shape, face, part.offset, &poses[block]);
                let over = over(&polygon, plane.normal, &others, far);
                if over.is_empty() {
                    continue;
                }
                let patches = self.close_face(closed, block, (&polygon, plane.normal), &over);
                let rims = &mut closed.rims[block];
                let around = (self.spacing, self.row);
                rim(rims, (&patches, plane.normal), solids.clone(), around);
                // What is outside is not dry, but not known.
                let [low, high] = self.domain;
                rims.retain(|at| at.place.cmpge(low).all() && at.place.cmple(high).all());
            }
        }
    }

    /// Adds what of a face of a block the parts over it close, and returns the most that each of them does.
    fn close_face(
        &self,
        closed: &mut Closed,
        block: usize,
        (polygon, normal): (&[DVec3], DVec3),
        over: &[&Other],
    ) -> Vec<Vec<DVec3>> {
        let under = |height: f64| {
            let height = height * self.spacing;
            let patches = over.iter();
            let patches = patches.map(|other| covered(polygon, normal, &other.part, [height]));
            patches.collect::<Vec<_>>()
        };
        let thin = under(THIN);
        let mut widest = thin.clone();
        for height in HEIGHTS {
            let patches = under(height).into_iter().zip(&thin);
            let patches =
                patches.map(|(far, thin)| if far.1 < thin.1 { thin.clone() } else { far });
            let patches: Vec<_> = patches.collect();
            let area: f64 = patches.iter().map(|(_, area)| area).sum();
            // Blocks that overlap do not close it twice.
            let share = (area_of(polygon).1.length() / area).min(1.0);
            for ((patch, widest), other) in patches.into_iter().zip(&mut widest).zip(over) {
                if patch.1 > widest.1 {
                    widest.clone_from(&patch);
                }
                if patch.1 > 0.0 {
                    closed.joints.push(Joint {
                        block,
                        other: other.block,
                        way: other.way,
                        corners: patch.0,
                        normal: share / HEIGHTS.len() as f64 * normal,
                    });
                }
            }
        }
        widest.into_iter().map(|(patch, _)| patch).collect()
    }

    /// Adds what the water in closed joints does to blocks, where their rims have the pressures `pressures` (Pa).
    pub fn push(&self, mut closed: Closed, pressures: &[f64], poses: &[Pose], loads: &mut [Load]) {
        let samples = closed.rims.iter_mut().flatten();
        for (sample, pressure) in samples.zip(pressures) {
            sample.pressure = *pressure;
        }
        let rims = closed.rims.iter();
        let heads: Vec<_> = rims
            .map(|rim| Head::fit(rim, self.reach, self.weight))
            .collect();
        let beside = closed.joints.iter();
        let beside: Vec<_> = beside
            .map(|joint| (joint.block, joint.other, joint.way))
            .collect();
        // Dry rims are known too.
        let unknown = |block: usize| self.loaded[block] && closed.rims[block].is_empty();
        let inside = passed_on(&heads, unknown, &beside);
        for joint in &closed.joints {
            let heads = match [joint.block, joint.other].map(|block| heads[block]) {
                [None, None] => (inside[joint.block], inside[joint.other]),
                [own, other] => (own, other),
            };
            let pressure: Box<dyn Fn(DVec3) -> f64> = match heads {
                (None, None) => continue,
                (Some(own), Some(other)) => {
                    Box::new(move |x| 0.5 * (own.at(x) + other.at(x - joint.way)))
                }
                (Some(own), None) => Box::new(move |x| own.at(x)),
                (None, Some(other)) => Box::new(move |x| other.at(x - joint.way)),
            };
            let load = &mut loads[joint.block];
            let centre = poses[joint.block].centre;
            press(load, &joint.corners, joint.normal, centre, pressure);
        }
    }
}

impl Closed {
    /// Places (m) on the rims, of which [`Sealed::push`] wants the pressures.
    pub fn places(&self) -> Vec<DVec3> {
        let samples = self.rims.iter().flatten();
        samples.map(|sample| sample.place).collect()
    }
}

/// The lower or the upper corner of the domain, infinite where it repeats, m.
fn ends(setup: &Setup, end: usize) -> DVec3 {
    DVec3::from([0, 1, 2].map(|axis| match (setup.faces[axis][end], end) {
        (Side::Periodic, 0) => f64::NEG_INFINITY,
        (Side::Periodic, _) => f64::INFINITY,
        (_, 0) => setup.origin[axis],
        _ => setup.origin[axis] + setup.size[axis],
    }))
}

/// Those of `parts` that may be within `far` (m) over a polygon.
fn over<'a>(polygon: &[DVec3], normal: DVec3, parts: &'a [Other], far: f64) -> Vec<&'a Other> {
    let middle = polygon.iter().sum::<DVec3>() / polygon.len() as f64;
    let apart = polygon.iter().map(|x| (x - middle).length());
    let radius = apart.fold(0.0, f64::max);
    let near = |Other { part, .. }: &&Other| {
        let way = part.centre - middle;
        let height = normal.dot(way);
        let beside = (way - height * normal).length() <= radius + part.radius;
        beside && height >= -part.radius && height <= far + part.radius
    };
    parts.iter().filter(near).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::Polyhedron;
    use glam::DQuat;
    use std::f64::consts::PI;

    fn at(x: f64, y: f64, z: f64) -> Pose {
        let centre = DVec3::new(x, y, z);
        Pose::rigid(centre, DQuat::IDENTITY, DVec3::ZERO, DVec3::ZERO)
    }

    fn cuboid(x: f64, y: f64, z: f64) -> Arc<Shape> {
        Arc::new(Polyhedron::cuboid(DVec3::new(x, y, z)).unwrap().into())
    }

    /// Sealed joints of water at 10 kPa/m under the level `level` (m), for the loads on all blocks.
    fn loads(
        shapes: Vec<Arc<Shape>>,
        poses: &[Pose],
        period: Option<Period>,
        level: impl Fn(DVec3) -> f64,
    ) -> Vec<Load> {
        let mut setup = Setup::tank(DVec3::new(40.0, 40.0, 20.0), 0.1, 10.0);
        setup.origin = DVec3::new(-20.0, -20.0, -0.6);
        setup.gravity = DVec3::Z * -10.0;
        let asked = vec![true; shapes.len()];
        let sealed = Sealed::new(shapes, period, &setup, &asked);
        let closed = sealed.closed(poses, &vec![true; poses.len()]);
        let pressure = |x: &DVec3| (1e4 * (level(*x) - x.z)).max(0.0);
        let pressures: Vec<f64> = closed.places().iter().map(pressure).collect();
        let mut loads = vec![Load::default(); poses.len()];
        sealed.push(closed, &pressures, poses, &mut loads);
        loads
    }

    /// A dam on its base: uplift between two levels, its moment, and nothing where there is room for water.
    #[test]
    fn uplift_falls_linearly_from_heel_to_toe() {
        let shapes = vec![cuboid(4.0, 1.0, 3.0), cuboid(20.0, 0.9, 1.0)];
        for (gap, share) in [(0.0, 1.0), (0.15, 0.5), (0.19, 0.0)] {
            let poses = [at(0.0, 0.0, 1.5 + gap), at(0.0, 0.0, -0.5)];
            // 30 kPa at the heel and none at a dry toe.
            for (down, mean) in [(1.0, 20e3), (0.0, 15e3)] {
                let found = loads(shapes.clone(), &poses, None, |x: DVec3| {
                    3.0 + (down - 3.0) * (0.25 * x.x + 0.5).clamp(0.0, 1.0)
                });
                let uplift = 4.0 * 0.9 * (mean - 1e4 * gap) * share;
                assert!(
                    (found[0].force - DVec3::Z * uplift).length() < 0.05 * uplift.max(1.0),
                    "{} {uplift}",
                    found[0].force
                );
                // ∫ p x dx about the middle, turning it downstream.
                let torque = 0.9 * 2.0 * (30e3 - mean) * 16.0 / 12.0 * share;
                let torque_found = found[0].torque();
                assert!(
                    (torque_found.y.abs() - torque).abs() < 0.1 * torque.max(1.0),
                    "{torque_found}"
                );
            }
        }
    }

    /// A dam of two blocks on a floor of two, all as wide as the period: nothing but heel and toe is a rim, also a spacing
    /// above the floor.
    #[test]
    fn what_is_closed_all_around_has_no_rim() {
        let period = Period {
            origin: DVec3::ZERO,
            size: DVec3::new(f64::INFINITY, 1.0, f64::INFINITY),
        };
        let shapes = vec![
            cuboid(2.0, 1.0, 3.0),
            cuboid(2.0, 1.0, 3.0),
            cuboid(10.0, 1.0, 1.0),
            cuboid(10.0, 1.0, 1.0),
        ];
        for gap in [0.0, 0.105] {
            // One of them half a period aside, the other two periods away.
            let poses = [
                at(-1.0, 0.5, 1.5 + gap),
                at(1.0, 2.0, 1.5 + gap),
                at(-5.0, 0.3, -0.5),
                at(5.0, 0.5, -0.5),
            ];
            let level = |x: DVec3| {
                // Water at both sides, and none in the dam, in its floor or in between.
                let inside = x.x.abs() < 2.0;
                if inside { -9.0 } else { 3.0 }
            };
            let found = loads(shapes.clone(), &poses, Some(period), level);
            let both = found[0].force + found[1].force;
            assert!((both.z / 12e4 - 1.0).abs() < 0.05, "{gap}: {both}");
            assert!(both.x.abs() < 1e-6 * both.z, "{gap}: {both}");
        }
    }

    /// Archimedes' push on every block inside of a mass of five by five by five, also on those that only others around them
    /// touch, which have no rims.
    #[test]
    fn water_goes_through_the_joints_of_a_mass() {
        let (mut poses, mut inside) = (Vec::new(), Vec::new());
        for n in 0..125 {
            let place = [n / 25, n / 5 % 5, n % 5];
            let [x, y, z] = place.map(f64::from);
            poses.push(at(x, y, 2.0 + z));
            inside.push(place.iter().all(|k| (1..4).contains(k)));
        }
        let found = loads(vec![cuboid(1.0, 1.0, 1.0); 125], &poses, None, |_| 15.0);
        let push = DVec3::Z * 1e4;
        for (load, _) in found.iter().zip(&inside).filter(|(_, inside)| **inside) {
            assert!((load.force - push).length() < 1.0, "{}", load.force);
            assert!(load.torque().length() < 1.0, "{}", load.torque());
        }
    }

    /// Three columns on a floor between water and a dry side: between those whose rims are dry there is none, whatever is
    /// beside them.
    #[test]
    fn water_does_not_go_through_blocks_to_a_dry_rim() {
        let column = || cuboid(2.0, 2.0, 3.0);
        let shapes = vec![column(), column(), column(), cuboid(20.0, 1.8, 1.0)];
        let poses = [
            at(-2.0, 0.0, 1.5),
            at(0.0, 0.0, 1.5),
            at(2.0, 0.0, 1.5),
            at(0.0, 0.0, -0.5),
        ];
        let level = |x: DVec3| if x.x < -2.5 { 3.0 } else { -9.0 };
        let found = loads(shapes, &poses, None, level);
        assert!(found[0].force.z > 1e4, "{}", found[0].force);
        assert_eq!(found[2].force.x, 0.0);
    }

    /// On a slope above the water, and with its foot in it.
    #[test]
    fn what_is_dry_has_no_pressure() {
        let shapes = vec![cuboid(2.0, 1.0, 1.0), cuboid(20.0, 3.0, 1.0)];
        let poses = [at(0.0, 0.0, 0.5), at(0.0, 0.0, -0.5)];
        let dry = loads(shapes.clone(), &poses, None, |_| -3.0);
        assert_eq!(dry, [Load::default(); 2]);
        // A slope of 30° that leaves the water in the middle of the joint.
        let turn = DQuat::from_rotation_y(PI / 6.0);
        let poses = poses.map(|pose| {
            let centre = turn * pose.centre;
            Pose::rigid(centre, turn, DVec3::ZERO, DVec3::ZERO)
        });
        let half = loads(shapes, &poses, None, |_| 0.0);
        let push = turn * DVec3::Z * 2.5e3;
        assert!((half[0].force - push).length() < 25.0, "{}", half[0].force);
    }

    #[test]
    fn half_of_a_face_beyond_an_edge_is_open_and_two_blocks_share_a_joint() {
        let shapes = vec![cuboid(1.0, 1.0, 1.0), cuboid(1.0, 1.0, 1.0)];
        let poses = [at(0.0, 0.0, 1.0), at(0.5, 0.0, 0.0)];
        let found = loads(shapes, &poses, None, |_| 1.5);
        assert!((found[0].force - DVec3::Z * 5e3).length() < 1.0);
        assert!((found[1].force + DVec3::Z * 5e3).length() < 1.0);
    }
}
