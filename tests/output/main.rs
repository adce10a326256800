//! Files, and quantities derived for them.

mod files;
mod velocity_quantities;
