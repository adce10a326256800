//! Shapes of blocks: polyhedra, meshes, compounds, and rock masses cut by joints.

mod closed_forms;
mod measure;
mod polyhedra;
mod refusals;
mod rock_masses;
