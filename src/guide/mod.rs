//! Theory, by engine: equations, sources, and limits.
//!
//! | engine | subject | modules |
//! |---|---|---|
//! | [`lattice`] | a fluid that fills its domain: D3Q27 lattice Boltzmann, on the device | [`crate::lattice`] |
//! | [`solids`] | blocks and terrain in that fluid, and the loads on them | [`crate::psm`], [`crate::coupling`] |
//! | [`rock`] | blocks, their contacts and their motion, on the host | [`crate::rock`], [`crate::rock::contact`], [`crate::rock::law`] |
//! | [`water`] | water with a free surface: SPH, on the device | [`crate::sph`] |
//!
//! A scene in SI units ([`crate::scene`]) chooses among them: `[fluid]` alone is the lattice, blocks alone are
//! rock, both are coupled, and with `[particles]` the water is SPH. Both fluids exchange the same two structures with
//! blocks: they take a [`Pose`](crate::geometry::Pose) and return a [`Load`](crate::geometry::Load).
//!
//! The errors on these pages were measured on lavapipe (Mesa's Vulkan driver for CPUs) by `riprap validate` and `riprap
//! report` of the harness unless a page says otherwise. The book in `docs/` has these pages and the tables of results.

#[doc = include_str!("../../docs/src/theory/lattice.md")]
pub mod lattice {}

#[doc = include_str!("../../docs/src/theory/solids.md")]
pub mod solids {}

#[doc = include_str!("../../docs/src/theory/rock.md")]
pub mod rock {}

#[doc = include_str!("../../docs/src/theory/water.md")]
pub mod water {}
