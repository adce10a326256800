//! Every finder of pairs gives the list that follows from the definition.

mod device;
mod host;
#[path = "../rig/mod.rs"]
mod rig;
mod scenes;
