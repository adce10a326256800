//! Files, and quantities that are derived for them.

mod files;
mod velocity_quantities;
