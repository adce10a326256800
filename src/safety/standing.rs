//! The safety of a block among its neighbours.

use super::{Base, Plane, Sliding, TILT, Wrench, sliding, toppling, touching::touching, uplift};
use crate::rock::{Blocks, Setup};
use glam::DVec3;

/// Cosine of the angle between the normals of contacts of one plane, 5°: contacts of plane faces differ by less.
const SAME: f64 = 0.996;

/// How safely a block stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// Against sliding.
    pub sliding: Sliding,
    /// Against uplift: see [`uplift`].
    pub uplift: f64,
    /// Against toppling over the edges of the plane that carries the most: see [`toppling`].
    pub toppling: f64,
}

/// Contacts of one plane.
#[derive(Clone, Debug, Default)]
struct Support {
    plane: Plane,
    /// Σ A tan φ and Σ A c.
    friction: f64,
    cohesion: f64,
    corners: Vec<DVec3>,
}

impl Support {
    /// Whether a block may begin to turn about an axis through `edge`: none of the corners then moves into the plane, by
    /// more than the tilt of contacts over their distance from the axis. Where one is on the axis itself, rounding gives its direction,
    /// so that the distance is that of the farthest.
    fn lets_turn(&self, axis: DVec3, edge: DVec3) -> bool {
        let directions = self.corners.iter().map(|x| axis.cross(*x - edge));
        let farthest = directions.clone().map(DVec3::length).fold(0.0, f64::max);
        let into = directions.map(|direction| -direction.dot(self.plane.normal));
        into.fold(0.0, f64::max) <= TILT * farthest
    }
}

impl Standing {
    /// Of the block `block` of `blocks`, which were made of `setup`, under the `force` (N) and `torque` about its
    /// centroid (N m) of a fluid with its buoyancy; zero where there is none. What else acts on the block counts too,
    /// but no guide of it: one that holds it is left out.
    pub fn of(setup: &Setup, blocks: &Blocks, block: usize, [force, torque]: [DVec3; 2]) -> Self {
        let pose = blocks.poses()[block];
        let weight = blocks.mass(block) * blocks.gravity();
        let supports = supports(setup, blocks, block);
        let planes: Vec<Plane> = supports.iter().map(|support| support.plane).collect();
        let fluid = Wrench { force, torque };
        let [push, turn] = blocks.applied_load(block);
        let acting = Wrench {
            force: push,
            torque: turn,
        };
        let force = fluid.force + acting.force;
        let resultant = weight + force;
        let pressed = |support: &&Support| -resultant.dot(support.plane.normal);
        let most = supports
            .iter()
            .max_by(|a, b| pressed(a).total_cmp(&pressed(b)));
        let base = most.map_or_else(Base::default, |support| Base {
            normal: support.plane.normal,
            corners: support.corners.clone(),
        });
        let others = supports.iter();
        let others = others.filter(|support| support.plane.normal != base.normal);
        let open = |axis: DVec3, edge: DVec3| {
            let mut others = others.clone();
            others.all(|support| support.lets_turn(axis, edge))
        };
        Self {
            sliding: sliding(resultant, &planes),
            uplift: uplift(weight, force),
            toppling: toppling(weight, &[fluid, acting], pose.centre, &base, open),
        }
    }
}

/// The planes that a block touches.
fn supports(setup: &Setup, blocks: &Blocks, block: usize) -> Vec<Support> {
    let mut supports: Vec<Support> = Vec::new();
    for touch in touching(setup, blocks, block) {
        let joint = blocks.joint([block, touch.other]);
        let same = |support: &Support| support.plane.normal.dot(touch.normal) > SAME;
        let known = supports.iter().position(same).unwrap_or_else(|| {
            supports.push(Support::default());
            supports.len() - 1
        });
        let support = &mut supports[known];
        let (area, mean) = (support.plane.area, support.plane.normal);
        let whole = area + touch.area;
        support.friction += touch.area * joint.friction_angle.tan();
        support.cohesion += touch.area * joint.cohesion;
        support.plane = Plane {
            normal: (area * mean + touch.area * touch.normal).normalize_or(touch.normal),
            area: whole,
            cohesion: support.cohesion / whole,
            friction_angle: (support.friction / whole).atan(),
        };
        support.corners.extend(touch.corners);
    }
    supports
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A side wall of a block that topples along it, whose normal leans by `tilt` (rad) against the motion.
    fn side_wall(tilt: f64) -> Support {
        let corner = |(x, z)| DVec3::new(x, 0.0, z);
        Support {
            plane: Plane {
                normal: DVec3::new(tilt, 1.0, 0.0).normalize(),
                ..Plane::default()
            },
            corners: [(0.0, 0.0), (1.0, 0.0), (1.0, 2.0), (0.0, 2.0)]
                .map(corner)
                .into(),
            ..Support::default()
        }
    }

    #[test]
    fn a_wall_along_the_way_holds_no_edge_whatever_the_tilt_of_its_contact() {
        for axis in [DVec3::Y, -DVec3::Y] {
            for tilt in [1e-6, -1e-6, 1e-4, -1e-4] {
                assert!(
                    side_wall(tilt).lets_turn(axis, DVec3::ZERO),
                    "{axis} {tilt}"
                );
            }
        }
        assert!(!side_wall(0.01).lets_turn(-DVec3::Y, DVec3::ZERO));
        // Into the wall itself.
        assert!(!side_wall(0.0).lets_turn(DVec3::X, DVec3::ZERO));
        assert!(side_wall(0.0).lets_turn(-DVec3::X, DVec3::ZERO));
    }
}
