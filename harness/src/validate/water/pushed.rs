//! A tank of water that is suddenly accelerated: pressure on its end walls, from sensors. At first it is the load of an
//! earthquake on a dam (Westergaard 1933), later the tank sloshes; the theory of waves of small amplitude covers both:
//! p = ρ a (L/2 − Σ 4 L/(n π)² cosh k z / cosh k H cos ω t), n odd, k = n π/L, ω² = g k tanh k H, added on one wall and
//! subtracted on the other.

use crate::validate::{
    CaseContext, Outcome, Record,
    tank::{self, GRAVITY, Tank},
};
use riprap::scene::Scene;
use std::f64::consts::PI;

const DEPTH: f64 = 1.0;
/// Lengths of the tanks, m: the longer one is practically infinite at first.
const LENGTHS: [f64; 2] = [2.0, 5.0];
/// Acceleration of the tank over gravity.
const PUSH: f64 = 0.05;
/// Height ranges of the sensors: at the foot of the walls, and over most of them.
const PATCHES: [(&str, [f64; 2]); 2] = [("foot", [0.0, 0.2]), ("wall", [0.0, 0.8])];
/// A tenth of the speed of sound, over that of long waves: sound echoes, which the theory lacks, are over soon.
const SOUND: f64 = 4.0;
/// Limit on the relative error, in spacings over the depth; chosen when the results were known.
const MOST: f64 = 2.0;
/// The end walls, and their normals into the water.
const SIDES: [[&str; 2]; 2] = [["left", "+x"], ["right", "-x"]];
/// Ends of the times over which pressures are averaged, in passages of a long wave through the depth. Sound crosses the depth
/// forty times in the first one.
const ENDS: [f64; 2] = [1.0, 4.0];

/// Mean pressure over a range of heights and over the time up to `end`, over ρ a H.
fn exact(length: f64, [low, high]: [f64; 2], end: f64) -> f64 {
    let mode = |n: u32| {
        let k = PI * f64::from(n) / length;
        let turn = (GRAVITY * k * (k * DEPTH).tanh()).sqrt() * end;
        // sinh k z / cosh k H, without overflow.
        let over = |z: f64| {
            (k * (z - DEPTH)).exp() * (1.0 - (-2.0 * k * z).exp())
                / (1.0 + (-2.0 * k * DEPTH).exp())
        };
        let share = 4.0 * length / (f64::from(n) * PI).powi(2);
        share * (over(high) - over(low)) / (k * (high - low)) * turn.sin() / turn
    };
    let modes: f64 = (1..400).step_by(2).map(mode).sum();
    (0.5 * length - modes) / DEPTH
}

/// Mean pressures on the end walls: half the difference between the two.
pub fn run(context: &CaseContext) -> Outcome {
    let layers: &[u32] = if context.full { &[25, 50] } else { &[25] };
    let mut records = Vec::new();
    for (layers, length) in layers
        .iter()
        .flat_map(|n| LENGTHS.map(|length| (*n, length)))
    {
        records.extend(measure(context, layers, length)?);
    }
    records.extend(strike(context)?);
    Ok(records)
}

/// A tank of `size` (m) with sensors on both ends, water up to x = `reach`, and a high speed of sound.
fn tank(size: [f64; 2], spacing: f64, reach: f64) -> anyhow::Result<Scene> {
    let sensors: String = PATCHES
        .iter()
        .flat_map(|patch| [(patch, 0.0, SIDES[0]), (patch, size[0], SIDES[1])])
        .map(|((name, [low, high]), at, [side, normal])| {
            format!(
                "[[probes]]\nname = \"{name}_{side}\"\nkind = \"sensor\"\nat = [{at}, 0.5, {}]\n\
                 normal = \"{normal}\"\nsize = {}\n",
                0.5 * (low + high),
                high - low
            )
        })
        .collect();
    let mut scene = tank::pool(size, spacing, [reach, DEPTH], &sensors)?;
    if let Some(particles) = &mut scene.particles {
        particles.largest_speed = Some(SOUND * (GRAVITY * DEPTH).sqrt());
    }
    Ok(scene)
}

/// Impulse since the start on one of the sensors, Pa s.
fn impulse(pool: &Tank<'_>, name: &str, [side, _]: [&str; 2]) -> f64 {
    let sensor = pool.simulation.sensor(&format!("{name}_{side}"));
    sensor.map_or(f64::NAN, |sensor| sensor.impulse)
}

fn measure(context: &CaseContext, layers: u32, length: f64) -> anyhow::Result<Vec<Record>> {
    let spacing = DEPTH / f64::from(layers);
    let mut scene = tank([length, 1.4 * DEPTH], spacing, length)?;
    scene.fluid.acceleration[0] = (-PUSH * GRAVITY).into();
    let mut pool = Tank::fill(context, &scene)?;
    let mut records = Vec::new();
    for passages in ENDS {
        pool.advance_to(passages * (DEPTH / GRAVITY).sqrt())?;
        let time = pool.simulation.time();
        for (name, heights) in PATCHES {
            let [more, less] = SIDES.map(|side| impulse(&pool, name, side));
            let more = 0.5 * (more - less) / time;
            let unit = 1000.0 * PUSH * GRAVITY * DEPTH;
            let trial = pool.trial(&format!("pushed, L/H {}", length / DEPTH));
            let what =
                format!("pressure at the {name} over {passages} √(H/g), ρaH, H/Δx = {layers}");
            let theory = exact(length, heights, time);
            records.push(trial.relative(what, more / unit, theory, MOST * spacing / DEPTH));
        }
    }
    Ok(records)
}

/// A block of water, four times as long as high, strikes a wall with its whole front. Reports the immediate impulse over that of
/// incompressible water that the wall can hold back (Cooker & Peregrine 1995, J. Fluid Mech. 297:193), which equals that of a
/// sudden push. Here walls only push, and the water bounces off: unlike the theory, and without a limit.
fn strike(context: &CaseContext) -> anyhow::Result<Vec<Record>> {
    let (size, speed) = ([6.0 * DEPTH, 4.0 * DEPTH], 1.0);
    let mut scene = tank(size, DEPTH / 25.0, 4.0 * DEPTH)?;
    // Hardly any gravity: the start needs some.
    scene.fluid.acceleration[2] = (-1e-3).into();
    scene.water[0].velocity = [-speed, 0.0, 0.0];
    let mut pool = Tank::fill(context, &scene)?;
    // Sound crosses the depth six times; jets have hardly begun.
    pool.advance_to(0.05 * DEPTH / speed)?;
    let trial = pool.trial("struck");
    let record = |(name, heights)| {
        let found = impulse(&pool, name, SIDES[0]) / (1000.0 * speed * DEPTH);
        let what = format!("impulse of water that strikes flat, ρUH, at the {name}");
        trial.relative(what, found, exact(40.0 * DEPTH, heights, 1e-4), None)
    };
    Ok(PATCHES.map(record).into())
}

#[cfg(test)]
mod tests {
    use super::exact;

    /// Westergaard's 8 G/π² at the foot and 16/π³ · 1.0518 over the whole wall of an endless reservoir.
    #[test]
    fn the_first_moment_is_westergaards() {
        let foot = exact(40.0, [0.0, 1e-3], 1e-4);
        let wall = exact(40.0, [0.0, 1.0], 1e-4);
        assert!((foot - 0.7425).abs() < 1e-3, "{foot}");
        assert!((wall - 0.5428).abs() < 2e-3, "{wall}");
    }
}
