//! What benches and the harness measure with: clocks, copies, and flows, piles and tanks of any size.

pub mod arithmetic;
pub mod clock;
pub mod copy;
pub mod exponent;
pub mod flow;
#[path = "../../tests/rig/gpu.rs"]
pub mod gpu;
pub mod pile;
pub mod stream_only;
pub mod subject;
pub mod tank;
