//! Where the energy is and where it went.

/// Energies since the start, J.
///
/// A block's kinetic and potential energy counts only if it is free. The law's springs conserve energy
/// only while the area of their contact stays (k_n A u_n has a potential in u_n alone): what they hold is
/// therefore the work that was done on them, and what they still hold when their contact ends is booked
/// as `lost`, positive or negative.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ledger {
    /// ½mv² + ½ω·L of the free blocks; ½mv² + ½ tr Ḟ S Ḟᵀ of those that deform.
    pub kinetic: f64,
    /// −m g·x of the free blocks, from the origin of the coordinates.
    pub potential: f64,
    /// ∫ ½E:C:E + σ₀:E of the blocks that deform.
    pub strain: f64,
    /// Work done on the springs of the present contacts, less what friction took of it. Negative where the area of a
    /// contact grew while it was pressed: its springs then give back more than they took.
    pub elastic: f64,
    /// Taken by friction.
    pub friction: f64,
    /// Taken by the dashpots of the contacts.
    pub dashpot: f64,
    /// Taken by the mass damping α.
    pub mass_damping: f64,
    /// Taken by films of fluid between blocks that nearly touch.
    pub film: f64,
    /// Held by springs whose contact ended: what the contact law took out, or put in where it is negative.
    pub lost: f64,
    /// Done on the blocks by what moves the driven ones.
    pub driven: f64,
    /// Done on the blocks by external loads, point loads and accelerations.
    pub loads: f64,
}

impl Ledger {
    /// What is there and what was taken, less what was put in: constant but for the error of the time
    /// integration.
    pub fn balance(&self) -> f64 {
        self.kinetic + self.potential + self.strain + self.elastic + self.taken()
            - self.driven
            - self.loads
    }

    /// Taken for good.
    pub fn taken(&self) -> f64 {
        self.friction + self.dashpot + self.mass_damping + self.film + self.lost
    }
}
