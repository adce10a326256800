//! Forces on single blocks that are formulas of time: at points, and on all of their mass.

use super::{Block, PointLoad};
use crate::{formula::Formula, geometry::outer, rock::integrate::Wrench};
use glam::{DMat3, DVec3};

/// Point loads and the acceleration of one block, in addition to gravity, contacts and loads.
#[derive(Clone, Debug)]
pub(super) struct AppliedForces {
    point_loads: Vec<PointLoad>,
    acceleration: Option<[Formula; 3]>,
}

impl AppliedForces {
    /// Of a block, if there is something.
    pub fn of(block: &Block) -> Option<Box<Self>> {
        let some = !block.point_loads.is_empty() || block.acceleration.is_some();
        some.then(|| {
            Box::new(Self {
                point_loads: block.point_loads.clone(),
                acceleration: block.acceleration.clone(),
            })
        })
    }

    /// Force and moment about the centroid at the time `t` (s) on the block of `mass` (kg) and
    /// `deformation`.
    pub fn wrench(&self, deformation: DMat3, mass: f64, t: f64) -> Wrench {
        let mut wrench = Wrench {
            force: self
                .acceleration
                .as_ref()
                .map_or(DVec3::ZERO, |a| mass * value(a, t)),
            moment: DMat3::ZERO,
        };
        for load in &self.point_loads {
            let force = value(&load.force, t);
            wrench.force += force;
            wrench.moment += outer(force, deformation * load.point);
        }
        wrench
    }
}

/// The value of three formulas of t (s).
pub(super) fn value(formulas: &[Formula; 3], t: f64) -> DVec3 {
    DVec3::from_array(formulas.each_ref().map(|f| f.eval_at([0.0; 3], t)))
}
