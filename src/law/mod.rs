//! The force of a contact (Hart, Cundall & Lemos 1988) and the elasticity of a block (St. Venant & Kirchhoff).

mod elastic;
mod hart;
mod joint;
mod stability;

pub use elastic::{Elastic, von_mises};
pub(crate) use elastic::{inner, trace};
pub use hart::{Force, History, Motion, Section, force};
pub use joint::Joint;
pub use stability::{LARGEST_SHARE, Stiffness, USUAL_SHARE, longest_step};
