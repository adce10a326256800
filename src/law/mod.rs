//! The force of a contact (Hart, Cundall & Lemos 1988).

mod hart;
mod joint;
mod stability;

pub use hart::{Force, History, Motion, Section, force};
pub use joint::Joint;
pub use stability::{LARGEST_SHARE, Stiffness, USUAL_SHARE, longest_step};
