//! Wall model: a law of the wall gives the friction of walls whose near-wall layer the grid does not resolve.

mod channel;
mod streams;

pub use channel::{channel, rough_channel};
pub use streams::{blocks, duct, rods, surfaces};

/// Initial mean velocity.
const BULK: f64 = 0.04;
/// Number of states averaged.
const SAMPLES: u64 = 100;
/// Re_τ and the mean velocity over the friction velocity (Lee & Moser 2015).
const CHANNELS: [(f64, f64); 2] = [(1000.0, 19.99), (5200.0, 24.1)];

/// Mean velocity of samples `each` steps apart, and the mean stress over the density: the fluid loses to the walls what the force
/// per mass adds and it does not keep. `h`: cross-section over its perimeter.
fn mean_and_stress(bulk: &[f64], each: u64, h: f64, force: f64) -> [f64; 2] {
    let change = (bulk[bulk.len() - 1] - bulk[0]) / (SAMPLES * each) as f64;
    let mean = bulk.iter().sum::<f64>() / bulk.len() as f64;
    [mean, h * (force - change)]
}
