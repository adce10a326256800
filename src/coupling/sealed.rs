//! Free water in joints that have no room for its particles.

use super::{
    across::Across,
    head::{Head, Sample},
    over::{Other, covered, others, press},
    passed_on::passed_on,
    rim::{Edge, rim},
};
use crate::{
    block::{Form, Shape},
    bodies::{Load, Period, Pose, outer},
    contact::Placed,
    immersed::{area_of, corners},
    particles::{Scheme, Setup, Side},
};
use glam::DVec3;
use std::sync::Arc;

/// Where a block that is too thin for the heights of [`Across`] still is found, if it touches, spacings.
const THIN: f64 = 0.25;

/// Where blocks are closer than the support of the kernel function the water between them pushes with a part of its pressure
/// only, and where they touch with none: [`Across`] tells what is missing. Water does push: a joint carries the pressure that its
/// rim has, between two levels falling linearly from one to the other, as dam engineers assume for uplift. It is that of the
/// linear field over the rims of all joints of the two blocks ([`Head`]); of blocks that are all in joints it is that of
/// those around.
#[derive(Debug)]
pub(crate) struct Sealed {
    shapes: Vec<Arc<Shape>>,
    /// Blocks whose loads somebody wants.
    loaded: Vec<bool>,
    period: Option<Period>,
    /// m.
    spacing: f64,
    across: Across,
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
    lips: Vec<Lip>,
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

/// A piece of the edge of a joint, where less of it is pressed.
#[derive(Debug)]
struct Lip {
    block: usize,
    other: usize,
    /// As of a joint, m.
    way: DVec3,
    /// m.
    place: DVec3,
    /// What the pressure there does to the block, m².
    lost: DVec3,
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
            across: Across::new(setup),
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
        let far = self.across.far();
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
                let (patches, shares) =
                    self.close_face(closed, block, (&polygon, plane.normal), &over);
                let rims = &mut closed.rims[block];
                let around = (self.spacing, self.row, &self.across);
                let ends = rim(rims, (&patches, plane.normal), solids.clone(), around);
                closed.lips.extend(lips(&patches, &ends).map(|(end, lost)| {
                    let other = over[end.polygon];
                    Lip {
                        block,
                        other: other.block,
                        way: other.way,
                        place: end.place,
                        lost: shares[end.polygon] * lost,
                    }
                }));
                let rims = &mut closed.rims[block];
                // What is outside is not dry, but not known.
                let [low, high] = self.domain;
                rims.retain(|at| at.place.cmpge(low).all() && at.place.cmple(high).all());
            }
        }
    }

    /// Adds what of a face of a block the parts over it close, and returns the most that each of them does, and the share of
    /// the pressure that it carries there.
    fn close_face(
        &self,
        closed: &mut Closed,
        block: usize,
        (polygon, normal): (&[DVec3], DVec3),
        over: &[&Other],
    ) -> (Vec<Vec<DVec3>>, Vec<f64>) {
        let under = |height: f64| {
            let patches = over.iter();
            let patches = patches.map(|other| covered(polygon, normal, &other.part, [height]));
            patches.collect::<Vec<_>>()
        };
        let thin = under(THIN * self.spacing);
        let mut widest = thin.clone();
        let mut areas = vec![0.0; over.len()];
        let heights = self.across.heights;
        for height in heights {
            let patches = under(height).into_iter().zip(&thin);
            let patches =
                patches.map(|(far, thin)| if far.1 < thin.1 { thin.clone() } else { far });
            let patches: Vec<_> = patches.collect();
            let area: f64 = patches.iter().map(|(_, area)| area).sum();
            // Blocks that overlap do not close it twice.
            let share = (area_of(polygon).1.length() / area).min(1.0);
            for (n, (patch, other)) in patches.into_iter().zip(over).enumerate() {
                let widest = &mut widest[n];
                areas[n] += share * patch.1 / heights.len() as f64;
                if patch.1 > widest.1 {
                    widest.clone_from(&patch);
                }
                if patch.1 > 0.0 {
                    closed.joints.push(Joint {
                        block,
                        other: other.block,
                        way: other.way,
                        corners: patch.0,
                        normal: share / heights.len() as f64 * normal,
                    });
                }
            }
        }
        let of = |(area, (_, most)): (&f64, &(Vec<DVec3>, f64))| area / most.max(f64::MIN_POSITIVE);
        let shares = areas.iter().zip(&widest).map(of).collect();
        let patches = widest.into_iter().map(|(patch, _)| patch).collect();
        (patches, shares)
    }

    /// Adds what the water in closed joints does to blocks, where their rims have the pressures `pressures` (Pa).
    pub fn push(&self, mut closed: Closed, pressures: &[f64], poses: &[Pose], loads: &mut [Load]) {
        let samples = closed.rims.iter_mut().flatten();
        for (sample, pressure) in samples.zip(pressures) {
            sample.pressure = *pressure;
        }
        let rims = closed.rims.iter();
        let heads: Vec<_> = rims
            .map(|rim| Head::fit(rim, self.across.reach, self.weight))
            .collect();
        let beside = closed.joints.iter();
        let beside: Vec<_> = beside
            .map(|joint| (joint.block, joint.other, joint.way))
            .collect();
        // Dry rims are known too.
        let unknown = |block: usize| self.loaded[block] && closed.rims[block].is_empty();
        let inside = passed_on(&heads, unknown, &beside);
        let between = |block: usize, other: usize, way: DVec3| {
            let heads = match [block, other].map(|block| heads[block]) {
                [None, None] => [inside[block], inside[other]],
                known => known,
            };
            let count = heads.iter().flatten().count();
            move |x: DVec3| match heads {
                [None, None] => 0.0,
                [own, other] => {
                    let own = own.map_or(0.0, |own| own.at(x));
                    let other = other.map_or(0.0, |other| other.at(x - way));
                    (own + other) / count as f64
                }
            }
        };
        for joint in &closed.joints {
            let pressure = between(joint.block, joint.other, joint.way);
            let load = &mut loads[joint.block];
            let centre = poses[joint.block].centre;
            press(load, &joint.corners, joint.normal, centre, pressure);
        }
        for lip in &closed.lips {
            let pressure = between(lip.block, lip.other, lip.way);
            let force = pressure(lip.place) * lip.lost;
            let load = &mut loads[lip.block];
            load.force += force;
            load.moment += outer(force, lip.place - poses[lip.block].centre);
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

/// The edges of patches with what each loses: those of a patch together not more than it has, and those of slivers nothing.
fn lips<'a>(patches: &[Vec<DVec3>], ends: &'a [Edge]) -> impl Iterator<Item = (&'a Edge, DVec3)> {
    let mut lost = vec![0.0; patches.len()];
    for end in ends {
        lost[end.polygon] += end.lost.length();
    }
    let part = |(patch, lost): (&Vec<DVec3>, f64)| {
        (area_of(patch).1.length() / lost.max(f64::MIN_POSITIVE)).min(1.0)
    };
    let parts: Vec<f64> = patches.iter().zip(lost).map(part).collect();
    ends.iter()
        .map(move |end| (end, parts[end.polygon] * end.lost))
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

    fn tank() -> Setup {
        let mut setup = Setup::tank(DVec3::new(40.0, 40.0, 20.0), 0.1, 10.0);
        setup.origin = DVec3::new(-20.0, -20.0, -0.6);
        setup.gravity = DVec3::Z * -10.0;
        setup
    }

    /// Sealed joints of water at 10 kPa/m under the level `level` (m), for the loads on all blocks.
    fn loads(
        shapes: Vec<Arc<Shape>>,
        poses: &[Pose],
        period: Option<Period>,
        level: impl Fn(DVec3) -> f64,
    ) -> Vec<Load> {
        let setup = tank();
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
        let shapes = vec![cuboid(4.0, 1.0, 3.0), cuboid(20.0, 3.0, 1.0)];
        let heights = Across::new(&tank()).heights;
        for gap in [0.0, 0.04, 0.12, 0.25] {
            let higher = heights.iter().filter(|height| **height > gap).count();
            let share = higher as f64 / heights.len() as f64;
            let poses = [at(0.0, 0.0, 1.5 + gap), at(0.0, 0.0, -0.5)];
            // 30 kPa at the heel and none at a dry toe.
            for (down, mean) in [(1.0, 20e3), (0.0, 15e3)] {
                let found = loads(shapes.clone(), &poses, None, |x: DVec3| {
                    3.0 + (down - 3.0) * (0.25 * x.x + 0.5).clamp(0.0, 1.0)
                });
                let uplift = 4.0 * (mean - 1e4 * gap) * share;
                assert!(
                    (found[0].force - DVec3::Z * uplift).length() < 0.05 * uplift.max(1.0),
                    "{} {uplift}",
                    found[0].force
                );
                // ∫ p x dx about the middle, turning it downstream.
                let torque = 2.0 * (30e3 - mean) * 16.0 / 12.0 * share;
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
        for gap in [0.0, 0.01] {
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
        assert!(found[2].force.x.abs() < 1e-9, "{}", found[2].force);
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
        // The lower side is pressed too much beside the floor, at half a metre of depth.
        let aside = 5e3 * Across::new(&tank()).lost(0.0);
        let push = turn * DVec3::new(-aside, 0.0, 2.5e3);
        assert!((half[0].force - push).length() < 25.0, "{}", half[0].force);
    }

    #[test]
    fn half_of_a_face_beyond_an_edge_is_open_two_blocks_share_a_joint_and_flush_sides_take_of_it() {
        let shapes = vec![cuboid(1.0, 1.0, 1.0), cuboid(1.0, 1.0, 1.0)];
        let poses = [at(0.0, 0.0, 1.0), at(0.5, 0.0, 0.0)];
        let found = loads(shapes, &poses, None, |_| 1.5);
        // Two edges are flush, and beyond the other two one of the blocks goes on.
        let lost = Across::new(&tank()).lost(0.0);
        let push = 1e4 * (0.5 - 2.0 * 0.5 * lost);
        // The sides above and below the joint are pressed too much beside it, which the other block would take up.
        let push = DVec3::new(-2.0 * 1e4 * lost, 0.0, push);
        assert!((found[0].force - push).length() < 1.0, "{}", found[0].force);
        assert!((found[1].force + push).length() < 1.0, "{}", found[1].force);
    }
}
