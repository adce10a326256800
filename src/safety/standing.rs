//! The safety of a block among its neighbours.

use super::{Base, Plane, Sliding, sliding, toppling, touching::touching, uplift};
use crate::bodies::{Blocks, Setup};
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

impl Standing {
    /// Of the block `block` of `blocks`, which were made of `setup`, under the `force` (N) and `torque` about its
    /// centroid (N m) of a fluid with its buoyancy; zero where there is none. What else acts on the block counts too.
    pub fn of(setup: &Setup, blocks: &Blocks, block: usize, [force, torque]: [DVec3; 2]) -> Self {
        let pose = blocks.poses()[block];
        let weight = blocks.mass(block) * blocks.gravity();
        let supports = supports(setup, blocks, block);
        let planes: Vec<Plane> = supports.iter().map(|support| support.plane).collect();
        let [push, turn] = blocks.acting(block);
        let (force, torque) = (force + push, torque + turn);
        let resultant = weight + force;
        let pressed = |support: &&Support| -resultant.dot(support.plane.normal);
        let most = supports
            .iter()
            .max_by(|a, b| pressed(a).total_cmp(&pressed(b)));
        let base = most.map_or_else(Base::default, |support| Base {
            normal: support.plane.normal,
            corners: support.corners.clone(),
        });
        // As its corners begin to move, none may move into a neighbour of another plane.
        let open = |axis: DVec3, edge: DVec3| {
            supports.iter().all(|support| {
                let own = support.plane.normal == base.normal;
                let mut ways = support.corners.iter().map(|x| axis.cross(*x - edge));
                own || ways.all(|way| way.dot(support.plane.normal) >= 0.0)
            })
        };
        Self {
            sliding: sliding(resultant, &planes),
            uplift: uplift(weight, force),
            toppling: toppling(resultant, torque, pose.centre, &base, open),
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
