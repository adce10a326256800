//! Every kernel in every variant is valid WGSL with exactly the bindings that it needs; the linker reports the position
//! of errors, and naga translates the kernels to the languages of all drivers.

mod constants;
mod errors;
mod files;
mod others;
mod single_cells;
mod specialise;
mod step;
mod translate;
