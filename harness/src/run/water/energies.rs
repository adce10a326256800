//! Where the energy of the water is and where it went, in numbers.

use riprap::simulation::WaterLedger;
use serde::Serialize;
use std::fmt;

/// Energies of the water against those at the start of the scene, and works since then, J.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Energies {
    /// Gain of kinetic energy.
    pub kinetic: f64,
    /// Gain of potential energy, by what is still there.
    pub potential: f64,
    /// Gain of energy of compression.
    pub compression: f64,
    /// What particles took along that have left, potential energy from the origin of the coordinates.
    pub left: f64,
    /// Done by free and driven blocks.
    pub bodies: f64,
    /// Done by what pushes water out of solids and blocks that do not move.
    pub pushed: f64,
    /// Done by dummy particles beyond the work of their walls and blocks: the error of this boundary condition.
    pub pressed: f64,
    /// Done and not there: dissipated, with the error of the computation.
    pub dissipated: f64,
    /// Given up by blocks to the water and in joints.
    pub blocks: f64,
    /// Given up by blocks in joints that have no particles.
    pub joints: f64,
    /// Given up by blocks to the water, and not got by it.
    pub unmatched: f64,
}

impl Energies {
    /// Of a ledger since the start.
    pub fn of(ledger: WaterLedger) -> Self {
        Self {
            kinetic: ledger.kinetic,
            potential: ledger.potential,
            compression: ledger.compression,
            left: ledger.left,
            bodies: ledger.bodies,
            pushed: ledger.pushed,
            pressed: ledger.pressed,
            dissipated: ledger.dissipated(),
            blocks: ledger.blocks,
            joints: ledger.joints,
            unmatched: ledger.unmatched(),
        }
    }
}

impl fmt::Display for Energies {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "  energy of the water: kinetic {:+.4e} J, potential {:+.4e} J, compression {:+.2e} J, left {:+.2e} J; work of \
             blocks {:+.4e} J, of walls that push {:+.2e} J, of dummy particles {:+.2e} J; dissipated {:.4e} J",
            self.kinetic,
            self.potential,
            self.compression,
            self.left,
            self.bodies,
            self.pushed,
            self.pressed,
            self.dissipated
        )?;
        if self.blocks == 0.0 && self.bodies == 0.0 {
            return Ok(());
        }
        write!(
            f,
            "\n  blocks gave up {:.4e} J, {:.2e} J of it in joints; the water got {:.4e} J, {:.2e} J are between them",
            self.blocks, self.joints, self.bodies, self.unmatched
        )
    }
}
