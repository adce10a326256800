//! `riprap check` and its input: reports, refusals, corrupted input, the scenes and the documents of the repository.

mod docs;
mod mutants;
mod refusals;
mod reports;
mod shipped_scenes;
