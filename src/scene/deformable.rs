//! Blocks that deform, and forces on single blocks.

use schemars::JsonSchema;
use serde::Deserialize;

use super::Axis;
use crate::formula::Formula;

/// A point of a deformable block that stays where it is at the start.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FixedPoint {
    /// The point in the block's own frame, m, in the block or on its surface.
    pub point: [f64; 3],
    /// Axes of the world along which it is held: one is a roller, all three a hinge. Default all.
    #[serde(default = "FixedPoint::all")]
    pub axes: Vec<Axis>,
}

impl FixedPoint {
    fn all() -> Vec<Axis> {
        Axis::ALL.into()
    }
}

/// A force on a point of a block.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointLoad {
    /// The point in the block's own frame, m, in the block or on its surface.
    pub point: [f64; 3],
    /// The force along the axes of the world, N: three numbers or formulas of t.
    pub force: [Formula; 3],
}
