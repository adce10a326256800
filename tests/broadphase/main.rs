//! Every finder of pairs gives the list that follows from the definition.

mod device;
mod host;
mod kernels;
mod layout;
#[path = "../rig/mod.rs"]
mod rig;
mod scan;
mod scenes;
mod workbench;
