//! Partially saturated cells against their f64 twin, and what must change no bit.

mod null;
mod placed;
mod reach;
#[path = "../rig/mod.rs"]
mod rig;
mod step;
mod subject;
#[path = "../twin/mod.rs"]
mod twin;
#[path = "../twin_of/mod.rs"]
mod twin_of;
