//! Contact of convex blocks.

mod caches;
mod centre;
mod closed_forms;
mod faults;
mod invariance;
mod laws;
mod normal;
mod pressure;
mod rock_mass;
mod separation;
mod sign;
mod spheres;
mod volume;
