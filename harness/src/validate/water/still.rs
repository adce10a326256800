//! Water at rest under its weight: p = ρ g (H − z).

use crate::validate::{
    CaseContext, Outcome, Trial,
    tank::{self, GRAVITY, Tank},
};
use riprap::scene::Scheme;

/// Depth and length of the tank, m.
const DEPTH: f64 = 1.0;
/// Passages of a long wave through the depth: by then initial errors are damped out.
const PASSAGES: f64 = 20.0;
/// The last of them, over which the residual motion is averaged.
const LOOKS: u32 = 10;

/// State of a still tank after a while.
pub struct Still {
    /// Setup and cost of the run.
    pub trial: Trial,
    /// Mean pressure at the bottom, Pa.
    pub bottom: f64,
    /// L2 error of the pressure over its norm.
    pub miss: f64,
    /// Residual speed over that of long waves.
    pub speed: f64,
}

/// Runs a tank `layers` spacings deep.
pub fn measure(context: &CaseContext, layers: u32, scheme: Scheme) -> anyhow::Result<Still> {
    let spacing = DEPTH / f64::from(layers);
    let mut scene = tank::pool([DEPTH, 1.5 * DEPTH], spacing, [DEPTH; 2], "")?;
    tank::choose(&mut scene, scheme);
    let mut pool = Tank::fill(context, &scene)?;
    let wave = (GRAVITY * DEPTH).sqrt();
    let (mut bottom, mut miss, mut speed) = (0.0, 0.0, 0.0);
    for look in 0..=LOOKS {
        let passages = PASSAGES - f64::from(LOOKS - look);
        pool.advance_to(passages * DEPTH / wave)?;
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

/// Pressure at the bottom at rest, Pa.
pub const BOTTOM: f64 = 1000.0 * GRAVITY * DEPTH;

/// Hydrostatic pressure, and how still the water is.
pub fn run(context: &CaseContext) -> Outcome {
    let layers: &[u32] = if context.full {
        &[10, 20, 40, 80]
    } else {
        &[10, 20]
    };
    let mut records = Vec::new();
    for &layers in layers {
        let found = measure(context, layers, Scheme::Delta)?;
        let trial = found.trial;
        let name = |what: &str| format!("{what}, H/Δx = {layers}");
        // The targets are those of twenty layers; coarser tanks show how the error falls.
        let limit = |limit| (layers >= 20).then_some(limit);
        let bottom = name("p at the bottom, Pa");
        records.push(trial.relative(bottom, found.bottom, BOTTOM, limit(0.02)));
        records.push(trial.at_most(name("L2(p)"), found.miss, limit(0.02)));
        records.push(trial.at_most(name("u_rms / √(gH)"), found.speed, limit(0.002)));
    }
    Ok(records)
}
