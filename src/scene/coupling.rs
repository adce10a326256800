//! How fluid and blocks meet.

use schemars::JsonSchema;
use serde::Deserialize;

use super::rules::refuse;
use super::{Motion, Scene, SolidOperator};
use crate::error::Result;

/// How often fluid and blocks exchange poses and loads.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct Coupling {
    /// Time steps of the fluid, of particles acoustic ones, from one exchange to the next, at least 1: meanwhile the blocks stand still for
    /// the fluid, and then they move under the mean of the loads since the last one. Default 1.
    pub interval: u32,
    /// Whether blocks feel the mean of the loads of two successive time steps (Owen, Leonardi & Feng 2011).
    /// Cells that a block fills reflect what is in them from step to step, so that single loads swing with
    /// a period of two steps, which the mean takes out. Without it free blocks need another solid operator
    /// than `holdych`. Default true.
    pub average: bool,
    /// Time for which all blocks are held where they start, s, while the flow settles around them and their
    /// loads are recorded; driven ones too. Default 0.
    pub hold: f64,
    /// Whether rigid blocks less than a cell from each other, from solids and from walls feel what the grid does not
    /// resolve of the fluid between them: the resistance of a film that is squeezed out, by lubrication theory with
    /// the viscosity of the fluid, down to gaps of a tenth of a cell; and what loads that come late lack between faces. Only on the
    /// lattice: particles have none.
    /// Default true.
    pub lubrication: bool,
    /// Hydraulic aperture of the closed joints of rigid blocks, m: they let through as much water as a slot so wide does (cubic law, with the
    /// viscosity of the fluid). It depends on cell and viscosity what is possible: `riprap check` says what joints have without this key, and the
    /// error of one that is too narrow or too wide names the range. A wider joint is an opening between the blocks. Only on the lattice, and
    /// with `numerics.solid_operator = "holdych"`.
    /// Default: as wide as possible.
    pub joint_aperture: Option<f64>,
}

impl Default for Coupling {
    fn default() -> Self {
        Self {
            interval: 1,
            average: true,
            hold: 0.0,
            lubrication: true,
            joint_aperture: None,
        }
    }
}

impl Scene {
    pub(super) fn check_coupling(&self) -> Result<()> {
        let coupling = &self.coupling;
        if coupling.interval == 0 {
            return refuse(
                "coupling.interval",
                "fluid and blocks would never meet; give a whole number of time steps, at least 1",
            );
        }
        if !(coupling.hold.is_finite() && coupling.hold >= 0.0) {
            return refuse(
                "coupling.hold",
                format!("is {}; give a time in s from 0 on", coupling.hold),
            );
        }
        if let Some(aperture) = coupling.joint_aperture
            && !(aperture.is_finite() && aperture > 0.0)
        {
            return refuse(
                "coupling.joint_aperture",
                format!("is {aperture}; give a width in m greater than 0"),
            );
        }
        if coupling.joint_aperture.is_some() && (self.has_particles() || !self.has_blocks()) {
            return refuse(
                "coupling.joint_aperture",
                "only blocks in a fluid on a lattice have closed joints with water; leave it out",
            );
        }
        if coupling.joint_aperture.is_some()
            && self.numerics.solid_operator != SolidOperator::Holdych
        {
            return refuse(
                "coupling.joint_aperture",
                "only joints with numerics.solid_operator = \"holdych\" can be of one aperture; leave it out",
            );
        }
        // Full cells throw back what is in them: a block that answers to single loads pushes itself ever harder.
        let free = self.blocks.iter().any(|block| block.motion == Motion::Free);
        let reflects = self.numerics.solid_operator == SolidOperator::Holdych;
        if self.has_fluid()
            && reflects
            && !coupling.average
            && (free || !self.rock_masses.is_empty())
        {
            return refuse(
                "coupling.average",
                "free blocks swing ever more under the single loads of solid_operator = \"holdych\"; use average = \
                 true, or solid_operator = \"noble\"",
            );
        }
        Ok(())
    }
}
