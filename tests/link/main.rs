//! Every kernel in every variant is valid WGSL with the bindings that it needs and no others; the
//! linker says where a text is wrong.

mod errors;
mod files;
mod single_cells;
mod specialise;
mod step;
