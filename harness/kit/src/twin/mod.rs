//! The fluid kernels in f64 and plain loops: the reference for GPU results.
//!
//! Everything is in lattice units (Δx = Δt = 1, c_s² = 1/3). Populations are stored shifted, f̃_i = f_i − w_i.
//! Cells are numbered x + nx (y + ny z).

mod block_friction;
pub mod collide;
pub mod diagnostics;
pub mod domain;
pub mod equilibrium;
pub mod flow;
pub mod golden;
pub mod joint;
pub mod lattice;
pub mod moments;
pub mod noise;
pub mod of_setup;
pub mod rates;
mod sloping_exchange;
mod sloping_friction;
pub mod solid;
pub mod statistics;
mod surface_friction;
pub mod wale;
pub mod wall_model;

pub use collide::collide;
pub use domain::{Domain, Face, Profile};
pub use flow::{Force, Twin};
pub use rates::{Config, Equilibrium, OddClass, Operator, Rates};
pub use solid::{Solid, SolidOperator, SolidWeight, tightness};
pub use wall_model::{WallLaw, WallModel};
