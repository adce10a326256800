//! Energy ledger of free water.

/// Energies of free water and work on it (Cercos-Pita, Antuono, Colagrossi & Souto-Iglesias 2017, Comput. Methods Appl.
/// Mech. Eng. 317:771), J. Work counts from the start.
///
/// The work of bodies on the water is minus the load on them along their motion in the steps of the water. Blocks move under
/// the mean of two loads and after the water, so the work of the blocks differs from it, and it includes the work in joints.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WaterLedger {
    /// Σ ½mv².
    pub kinetic: f64,
    /// −Σ m g·x, from the origin of the coordinates.
    pub potential: f64,
    /// Σ m ∫ p/ρ² dρ.
    pub compression: f64,
    /// Sum of the three energies of the escaped particles, each at the time of its escape.
    pub escaped: f64,
    /// Work of free and driven blocks on the water.
    pub bodies: f64,
    /// Work of the penalty force of fixed bodies on the water.
    pub penalty: f64,
    /// Work of boundary particles on the water beyond the work of their walls and bodies: the error of this boundary
    /// condition, proportional to the spacing. Most of it comes from corners next to moving bodies.
    pub boundary: f64,
    /// Work of blocks in joints that have no particles; it does not reach the water.
    pub joints: f64,
    /// Work of free and driven blocks on the water and in joints along their own motion.
    pub blocks: f64,
}

impl WaterLedger {
    /// Differences from the ledger at the `start`.
    pub fn since(&self, start: &Self) -> Self {
        Self {
            kinetic: self.kinetic - start.kinetic,
            potential: self.potential - start.potential,
            compression: self.compression - start.compression,
            escaped: self.escaped - start.escaped,
            bodies: self.bodies - start.bodies,
            penalty: self.penalty - start.penalty,
            boundary: self.boundary - start.boundary,
            joints: self.joints - start.joints,
            blocks: self.blocks - start.blocks,
        }
    }

    /// Total energy of the water, escaped particles included.
    pub fn total(&self) -> f64 {
        self.kinetic + self.potential + self.compression + self.escaped
    }

    /// Dissipated energy, of a ledger since a start: by viscosity and density diffusion, with the error of the time
    /// integration.
    pub fn dissipated(&self) -> f64 {
        self.bodies + self.penalty + self.boundary - self.total()
    }

    /// Work of blocks that the water did not receive, without joints: the error of the staggered exchange.
    pub fn unmatched(&self) -> f64 {
        self.blocks - self.joints - self.bodies
    }
}
