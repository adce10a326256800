//! How contacts are resolved.

/// Choices of a [`Resolver`](super::Resolver).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options {
    /// Which normal a contact gets.
    pub normal: Normal,
}

/// Definition of the contact normal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Normal {
    /// Σ a/t over one block's faces at the analytic centre, t their slacks: equal and opposite for
    /// both blocks, without a parameter; the face's own normal where faces lie flat on each other.
    #[default]
    Barrier,
    /// Gradient of Boon's potential particle, Σ ⟨a·x − d + r⟩² − r², the mean of both blocks', with
    /// r = max(2 u_n, d_min/100): at r = d_min/2, as often used, face contacts tilt by up to 10°.
    Potential,
}
