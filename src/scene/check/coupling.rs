//! Fluid and blocks can meet.

use super::rules::refuse;
use crate::error::Result;
use crate::scene::{Motion, Scene, SolidOperator};

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
