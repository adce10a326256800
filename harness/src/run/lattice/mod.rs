//! Files and numbers of a fluid on a lattice.

mod coupling;
mod fields;
mod max_speed;
mod probes;
mod walls;

pub use coupling::Coupling;
pub use fields::Fields;
pub use max_speed::MaxSpeed;
pub use probes::ProbeTable;
