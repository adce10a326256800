//! Reproducible noise.

use super::lattice::{Q, W};

/// Integer hash with good avalanche, so that an initial state is the same on every machine.
pub fn hash32(mut n: u32) -> u32 {
    n ^= n >> 16;
    n = n.wrapping_mul(0x7feb_352d);
    n ^= n >> 15;
    n = n.wrapping_mul(0x846c_a68b);
    n ^ (n >> 16)
}

/// w_i · amplitude · (r − ½), with r uniform in [0, 1) and determined by `cell`.
pub fn populations(cell: usize, amplitude: f64) -> [f64; Q] {
    std::array::from_fn(|i| {
        let r = f64::from(hash32((i + Q * cell) as u32)) / 4_294_967_296.0;
        W[i] * amplitude * (r - 0.5)
    })
}
