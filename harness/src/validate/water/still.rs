//! Water at rest under its weight: p = ρ g (H − z).

use super::{
    super::{Outcome, Stand, Trial},
    pool::{self, GRAVITY, Pool},
};
use riprap::scene::Scheme;

/// Depth and length of the tank, m.
const DEPTH: f64 = 1.0;
/// Passages of a long wave through the depth: what the start had wrong is damped away.
const PASSAGES: f64 = 20.0;
/// Of them those over which what is left is averaged.
const LOOKS: u32 = 10;

/// What a still tank is like after a while.
pub struct Still {
    /// What was run.
    pub trial: Trial,
    /// Mean pressure at the bottom, Pa.
    pub bottom: f64,
    /// Error of the pressure, of its norm.
    pub miss: f64,
    /// Speed that is left, of that of long waves.
    pub speed: f64,
}

/// A tank as deep as `layers` spacings.
pub fn measure(stand: &Stand, layers: u32, scheme: Scheme) -> anyhow::Result<Still> {
    let spacing = DEPTH / f64::from(layers);
    let mut scene = pool::scene([DEPTH, 1.5 * DEPTH], spacing, [DEPTH; 2], "")?;
    pool::choose(&mut scene, scheme);
    let mut pool = Pool::fill(stand, &scene)?;
    let wave = (GRAVITY * DEPTH).sqrt();
    let (mut bottom, mut miss, mut speed) = (0.0, 0.0, 0.0);
    for look in 0..=LOOKS {
        let passages = PASSAGES - f64::from(LOOKS - look);
        pool.advance(passages * DEPTH / wave)?;
        if look == 0 {
            continue;
        }
        let water = pool.water()?;
        let exact = |z: f64| 1000.0 * GRAVITY * (DEPTH - z);
        let (mut off, mut all, mut squares, mut sum, mut count) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for n in 0..water.len() {
            let (z, p) = (water.positions[n].z, water.pressures[n]);
            off += (p - exact(z)).powi(2);
            all += exact(z).powi(2);
            squares += f64::from(water.velocities[n].length_squared());
            if z < spacing {
                sum += p + 1000.0 * GRAVITY * z;
                count += 1.0;
            }
        }
        let share = f64::from(LOOKS).recip();
        bottom += share * sum / count;
        miss += share * f64::sqrt(off / all);
        speed += share * f64::sqrt(squares / water.len() as f64);
    }
    Ok(Still {
        trial: pool.trial("still tank"),
        bottom,
        miss,
        speed: speed / wave,
    })
}

/// Pressure at rest.
pub const BOTTOM: f64 = 1000.0 * GRAVITY * DEPTH;

/// Hydrostatic pressure, and how still the water is.
pub fn run(stand: &Stand) -> Outcome {
    let layers: &[u32] = if stand.full {
        &[10, 20, 40, 80]
    } else {
        &[10, 20]
    };
    let mut records = Vec::new();
    for &layers in layers {
        let Still {
            trial,
            bottom,
            miss,
            speed,
        } = measure(stand, layers, Scheme::Delta)?;
        let name = |what: &str| format!("{what}, H/Δx = {layers}");
        // The targets are those of twenty layers; coarser tanks show how the error falls.
        if layers < 20 {
            records.push(trial.report(name("p at the bottom, Pa"), bottom, Some(BOTTOM)));
            records.push(trial.report(name("L2(p)"), miss, None));
            records.push(trial.report(name("u_rms / √(gH)"), speed, None));
        } else {
            records.push(trial.relative(name("p at the bottom, Pa"), bottom, BOTTOM, 0.02));
            records.push(trial.at_most(name("L2(p)"), miss, 0.02));
            records.push(trial.at_most(name("u_rms / √(gH)"), speed, 0.002));
        }
    }
    Ok(records)
}
