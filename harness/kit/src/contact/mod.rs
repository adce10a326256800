//! Blocks as the contact laws and parry see them, and pairs of them with a known gap.

mod pairs;
mod solids;

pub use pairs::Couple;
pub use solids::{Random, Solid, ball};
