//! Partially saturated cells: the kernels against formulas in f64, the lattice step against its f64 twin, and the null model.

mod bindings;
mod combine_solids;
mod effective;
mod exact;
mod faces;
mod fixture;
mod layout;
mod null_model;
mod operators;
mod programs;
mod reduce;
mod shapes;
mod tile_search;
mod tiling;
mod twin_step;
mod voxelise;
mod wall_law;
