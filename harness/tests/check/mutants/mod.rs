//! Thousands of spoilt scenes and meshes: each is read or refused with a place, without a panic, a hang or a
//! great allocation.

mod dice;
mod judge;
mod meshes;
mod scenes;
