//! Shapes of blocks: polyhedra, meshes, compounds, and rock masses cut by joints.

mod closed_forms;
mod measure;
mod meshes;
mod polyhedra;
mod refusals;
mod rock_masses;
