//! Every kernel in every variant is valid WGSL with the bindings that it needs and no others; the
//! linker says where a text is wrong, and naga writes it in the languages of all drivers.

mod constants;
mod errors;
mod files;
mod others;
mod single_cells;
mod specialise;
mod step;
mod translate;
