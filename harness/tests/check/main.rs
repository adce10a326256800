//! `riprap check` and what it reads: reports, refusals, spoilt input, the scenes and the documents of the repository.

mod docs;
mod mutants;
mod refusals;
mod reports;
mod shipped_scenes;
