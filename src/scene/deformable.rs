//! Deformable blocks, and forces on single blocks.

use schemars::JsonSchema;
use serde::Deserialize;

use super::rules::{distinct, finite, finite_constants, refuse};
use super::{Axis, Block, BlockShape, Motion, Scene};
use crate::error::Result;
use crate::formula::Formula;

/// A point of a deformable block that is held in its initial position.
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

impl Scene {
    /// Checks the keys of the block at `key` for deformation and point loads.
    pub(super) fn check_deformable(&self, key: &str, block: &Block) -> Result<()> {
        if block.deformable {
            self.check_elastic(key, block.material.as_deref())?;
            let shape = &block.shape;
            if matches!(
                shape,
                BlockShape::Sphere { .. } | BlockShape::Compound { .. }
            ) {
                return refuse(
                    format!("{key}.deformable"),
                    format!(
                        "a block of kind `{}` is rigid; give one convex polyhedron, or remove deformable",
                        shape.kind()
                    ),
                );
            }
            if block.motion != Motion::Free {
                return refuse(
                    format!("{key}.deformable"),
                    "only a free block deforms; remove motion and hold it by fixed_points, or remove \
                     deformable",
                );
            }
            finite(format!("{key}.initial_stress"), &block.initial_stress)?;
        } else {
            for (name, given) in [
                ("initial_stress", block.initial_stress != [0.0; 6]),
                ("fixed_points", !block.fixed_points.is_empty()),
            ] {
                if given {
                    return refuse(
                        format!("{key}.{name}"),
                        "belongs to a deformable block; add deformable = true, or use motion = \"fixed\"",
                    );
                }
            }
        }
        for (number, held) in block.fixed_points.iter().enumerate() {
            let key = format!("{key}.fixed_points[{number}]");
            finite(format!("{key}.point"), &held.point)?;
            distinct(&format!("{key}.axes"), &held.axes)?;
        }
        for (number, load) in block.point_loads.iter().enumerate() {
            let key = format!("{key}.point_loads[{number}]");
            finite(format!("{key}.point"), &load.point)?;
            acting(&format!("{key}.force"), &load.force, block.motion)?;
        }
        match &block.acceleration {
            Some(formulas) => acting(&format!("{key}.acceleration"), formulas, block.motion),
            None => Ok(()),
        }
    }

    /// Checks that the material called `name`, or the first one, has the elasticity that the deformable blocks of the table
    /// `key` need.
    pub(super) fn check_elastic(&self, key: &str, name: Option<&str>) -> Result<()> {
        let index = self.material(&format!("{key}.material"), name)?;
        if self.materials[index].youngs_modulus.is_some() {
            return Ok(());
        }
        refuse(
            format!("{key}.deformable"),
            format!(
                "its material `{}` has no elasticity; give materials[{index}].youngs_modulus in Pa, such as \
                 5e10 for granite",
                self.materials[index].name
            ),
        )
    }
}

/// Checks formulas of t that act on a block with this motion.
fn acting(key: &str, formulas: &[Formula; 3], motion: Motion) -> Result<()> {
    if motion != Motion::Free {
        return refuse(
            key,
            "forces move free blocks alone; remove it, or remove motion",
        );
    }
    finite_constants(key, formulas)?;
    match formulas.iter().find(|formula| formula.uses_place()) {
        None => Ok(()),
        Some(formula) => refuse(
            key,
            format!("`{formula}` uses x, y or z; what acts on a block is a formula of t"),
        ),
    }
}
