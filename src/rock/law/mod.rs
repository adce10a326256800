//! The force of a contact (Hart, Cundall & Lemos 1988), the elasticity of a block (St. Venant & Kirchhoff), and the
//! resistance of fluid in a thin gap (Reynolds 1886).

mod elastic;
mod film;
mod hart;
mod load_delay;

pub(crate) use crate::geometry::inner;
pub(crate) use elastic::trace;
pub use elastic::{Elastic, von_mises};
pub use film::Film;
pub use hart::{
    Force, History, Joint, LARGEST_SHARE, Motion, Section, Stiffness, USUAL_SHARE, force,
    longest_step,
};
pub use load_delay::LoadDelay;
