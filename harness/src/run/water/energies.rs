//! Energy balance of the water in the summary.

use riprap::simulation::WaterLedger;
use serde::Serialize;
use std::fmt;

/// Changes of the energy of the water since the start of the scene, and work since then, J.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Energies {
    /// Gain of kinetic energy.
    pub kinetic: f64,
    /// Gain of potential energy of the particles inside the domain.
    pub potential: f64,
    /// Gain of compression energy.
    pub compression: f64,
    /// Energy of the escaped particles, with the potential energy relative to the origin.
    pub left: f64,
    /// Work of free and driven blocks.
    pub bodies: f64,
    /// Work of the penalty force of solids and fixed blocks.
    pub pushed: f64,
    /// Work of boundary particles beyond the work of their walls and blocks: the error of this boundary condition.
    pub pressed: f64,
    /// Dissipated energy, with the error of the time integration.
    pub dissipated: f64,
    /// Work of blocks on the water and in joints, along their own motion.
    pub blocks: f64,
    /// Work of blocks in joints that have no particles.
    pub joints: f64,
    /// Work of blocks on the water that it did not receive.
    pub unmatched: f64,
}

impl Energies {
    /// The balance of a ledger since the start.
    pub fn of(ledger: WaterLedger) -> Self {
        Self {
            kinetic: ledger.kinetic,
            potential: ledger.potential,
            compression: ledger.compression,
            left: ledger.escaped,
            bodies: ledger.bodies,
            pushed: ledger.penalty,
            pressed: ledger.boundary,
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
            "  energy of the water: kinetic {:+.4e} J, potential {:+.4e} J, compression {:+.2e} J, escaped {:+.2e} J; \
             work of blocks {:+.4e} J, of the penalty force {:+.2e} J, of boundary particles {:+.2e} J; dissipated {:.4e} J",
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
            "\n  work of blocks {:.4e} J, {:.2e} J of it in joints; the water received {:.4e} J, difference {:.2e} J",
            self.blocks, self.joints, self.bodies, self.unmatched
        )
    }
}
