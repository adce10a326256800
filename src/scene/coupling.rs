//! Coupling of fluid and blocks.

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
    /// Time steps of the fluid (acoustic steps for particles) from one exchange to the next, at least 1. In between, the blocks
    /// are at rest for the fluid; then they move under the mean of the loads since the last exchange. Default 1.
    pub interval: u32,
    /// Whether blocks move under the mean of the loads of two successive time steps (Owen, Leonardi & Feng 2011).
    /// Cells inside a block reflect their populations in every step, so that single loads oscillate with
    /// a period of two steps, which the mean removes. Without it free blocks need a solid operator
    /// other than `holdych`. Default true on the lattice. Default false for particles, where the delay of the mean makes free blocks
    /// that float oscillate.
    pub average: Option<bool>,
    /// Time for which all blocks, driven ones too, are held in their initial positions, s, while the flow develops and
    /// their loads are recorded. Default 0.
    pub hold: f64,
    /// Whether forces of unresolved fluid act on rigid blocks less than a cell from each other, from solids and from walls:
    /// the resistance of a film that is squeezed out, by lubrication theory with the viscosity of the fluid, down to gaps of a
    /// tenth of a cell, and a correction of the delay of loads between faces. Only on the lattice. Default true.
    pub lubrication: bool,
    /// Hydraulic aperture of the closed joints of rigid blocks, m: the width of a slot with the same conductivity (cubic law,
    /// with the viscosity of the fluid). The possible range depends on cell and viscosity: `riprap check` reports the default,
    /// and the error of a value out of range gives the range. A wider joint must be a gap between the blocks. Only on the
    /// lattice, and with `numerics.solid_operator = "holdych"`. Default: as wide as possible.
    pub joint_aperture: Option<f64>,
}

impl Default for Coupling {
    fn default() -> Self {
        Self {
            interval: 1,
            average: None,
            hold: 0.0,
            lubrication: true,
            joint_aperture: None,
        }
    }
}

impl Scene {
    /// Whether blocks move under the mean of two successive loads.
    pub fn averages_loads(&self) -> bool {
        self.coupling.average.unwrap_or(!self.has_particles())
    }

    pub(super) fn check_coupling(&self) -> Result<()> {
        let coupling = &self.coupling;
        if coupling.interval == 0 {
            return refuse(
                "coupling.interval",
                "fluid and blocks would never exchange loads; give a whole number of time steps, at least 1",
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
                "only joints with numerics.solid_operator = \"holdych\" can have a given aperture; leave it out",
            );
        }
        // Full cells reflect their populations: a block that responds to single loads amplifies its own motion.
        let free = self.blocks.iter().any(|block| block.motion == Motion::Free);
        let reflects = self.numerics.solid_operator == SolidOperator::Holdych;
        if self.has_fluid()
            && !self.has_particles()
            && reflects
            && !self.averages_loads()
            && (free || !self.rock_masses.is_empty())
        {
            return refuse(
                "coupling.average",
                "free blocks oscillate more and more under the single loads of solid_operator = \"holdych\"; use average = \
                 true, or solid_operator = \"noble\"",
            );
        }
        Ok(())
    }
}
