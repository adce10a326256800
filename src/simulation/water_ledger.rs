//! Where the energy of free water is and where it went.

/// Energies of free water and of what works on it (Cercos-Pita, Antuono, Colagrossi & Souto-Iglesias 2017, Comput. Methods
/// Appl. Mech. Eng. 317:771), J. Works count from the start.
///
/// What bodies do to the water is what they feel times how they moved in the steps of the water. Blocks move under the mean of
/// two loads, and after the water has: what they give up differs by that, and by what is in joints.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WaterLedger {
    /// Σ ½mv².
    pub kinetic: f64,
    /// −Σ m g·x, from the origin of the coordinates.
    pub potential: f64,
    /// Σ m ∫ p/ρ² dρ.
    pub compression: f64,
    /// All three of those that have left, when they did.
    pub left: f64,
    /// Done on the water by free and driven blocks.
    pub bodies: f64,
    /// Done on the water by the springs that push it out of what does not move.
    pub pushed: f64,
    /// Done on the water by dummy particles beyond the work of their walls and bodies: the error of this boundary condition,
    /// in proportion to the spacing and mostly that of corners beside bodies that move.
    pub pressed: f64,
    /// Given up by blocks in joints that have no water, and gone.
    pub joints: f64,
    /// Given up by free and driven blocks to the water and in joints, as they have moved.
    pub blocks: f64,
}

impl WaterLedger {
    /// The same since `start`.
    pub fn since(&self, start: &Self) -> Self {
        Self {
            kinetic: self.kinetic - start.kinetic,
            potential: self.potential - start.potential,
            compression: self.compression - start.compression,
            left: self.left - start.left,
            bodies: self.bodies - start.bodies,
            pushed: self.pushed - start.pushed,
            pressed: self.pressed - start.pressed,
            joints: self.joints - start.joints,
            blocks: self.blocks - start.blocks,
        }
    }

    /// What the water holds, and what has left.
    pub fn held(&self) -> f64 {
        self.kinetic + self.potential + self.compression + self.left
    }

    /// What was done on the water and is not there, of a ledger since a start: taken by viscosity and by the diffusion of
    /// density, with the error of the time integration.
    pub fn dissipated(&self) -> f64 {
        self.bodies + self.pushed + self.pressed - self.held()
    }

    /// What blocks gave up and the water did not get, joints apart: the error of the exchange, with which both go on by turns.
    pub fn unmatched(&self) -> f64 {
        self.blocks - self.joints - self.bodies
    }
}
