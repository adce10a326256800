//! What is solved, engine by engine: equations, where they come from, and how far they carry.
//!
//! | engine | what it computes | module |
//! |---|---|---|
//! | [`lattice`] | a fluid that fills its domain: D3Q27 lattice Boltzmann, on the device | [`crate::lattice`] |
//! | [`solids`] | blocks and terrain in that fluid, and what it does to them | [`crate::immersed`], [`crate::coupling`] |
//! | [`rock`] | blocks, their contacts and their motion, on the host | [`crate::bodies`], [`crate::contact`], [`crate::law`] |
//! | [`water`] | water with a free surface: smoothed particles, on the device | [`crate::particles`] |
//!
//! A scene in SI units ([`crate::scene`]) chooses among them: `[fluid]` alone is the lattice, blocks alone are
//! rock, both are coupled, and with `[particles]` the water is one of particles. Both fluids meet blocks through the same
//! two structures, [`Pose`](crate::bodies::Pose) in and [`Load`](crate::bodies::Load) out.
//!
//! Errors that these pages name were measured on lavapipe (Mesa's Vulkan on the CPU), by `riprap validate` and `riprap
//! report` of the harness unless a page says otherwise; the README has the tables.

#[doc = include_str!("lattice.md")]
pub mod lattice {}

#[doc = include_str!("solids.md")]
pub mod solids {}

#[doc = include_str!("rock.md")]
pub mod rock {}

#[doc = include_str!("water.md")]
pub mod water {}
