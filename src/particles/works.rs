//! What works on the water from outside.

/// Work on the water since the start, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Works {
    /// Of bodies that move and whose loads are asked for: against what the water does to them, as they moved in the
    /// water's steps.
    pub bodies: f64,
    /// Of the springs that push water out of bodies that do not move.
    pub pushed: f64,
    /// Of the dummy particles of walls and bodies beyond the work of these: they have pressures and no state, and give what
    /// they would have to take as bodies of water. Most of it comes from corners, where those of a wall that does not move
    /// push at water beside a body that does.
    pub pressed: f64,
}
