//! Waves made by a piston and by a falling box.

use crate::validate::{
    CaseContext, Outcome,
    tank::{self, GRAVITY, Tank},
};
use std::f64::consts::PI;

const DEPTH: f64 = 1.0;
const STROKE: f64 = 0.1;
const PERIOD: f64 = 2.0;
/// Distance from the mean position of the piston to the gauge, depths.
const GAUGE: f64 = 3.0;
/// Periods after which the wave at the gauge is fully developed, and those over which it is measured, before the reflection from
/// the far wall arrives.
const BEFORE: f64 = 3.0;
const MEASURED: f64 = 2.0;

/// Wave number of the period T in the depth h: ω² = g k tanh kh, by Newton's rule.
fn wave_number(period: f64, depth: f64) -> f64 {
    let target = (2.0 * PI / period).powi(2) * depth / GRAVITY;
    let mut x: f64 = target.max(target.sqrt());
    for _ in 0..50 {
        let (tanh, sech) = (x.tanh(), 1.0 / x.cosh());
        x -= (x * tanh - target) / (tanh + x * sech * sech);
    }
    x / depth
}

/// Height of the waves made by a piston, over its stroke: H/S = 2 (cosh 2kh − 1)/(sinh 2kh + 2kh) (Dean & Dalrymple 1991).
pub fn piston(context: &CaseContext) -> Outcome {
    let layers = 20;
    let spacing = DEPTH / f64::from(layers);
    // The fastest waves run at √(gH): from the piston to the far wall and back to the gauge.
    let way = (BEFORE + MEASURED) * PERIOD * (GRAVITY * DEPTH).sqrt();
    let length = (0.5 * (way + GAUGE * DEPTH) / spacing).ceil() * spacing;
    // The piston starts at one end of its stroke, with its face half a spacing in front of the particle lattice of the water.
    let thick = 10.0 * spacing;
    let speed = STROKE * PI / PERIOD;
    let more = format!(
        r#"
        [[blocks]]
        name = "piston"
        kind = "box"
        size = [{thick}, 1, {}]
        position = [{}, 0.5, {}]
        motion = "driven"
        velocity = ["{speed}*sin({}*t)", 0, 0]
        "#,
        2.0 * DEPTH,
        0.5 * thick,
        DEPTH,
        2.0 * PI / PERIOD,
    );
    let size = [length + thick, 1.6 * DEPTH];
    let mut scene = tank::pool(size, spacing, [length + thick, DEPTH], &more)?;
    if let Some(particles) = &mut scene.particles {
        // Waves of a tenth of the depth are far slower than a fall through the depth.
        particles.largest_speed = Some((GRAVITY * DEPTH).sqrt());
    }
    let mut pool = Tank::fill(context, &scene)?;
    let gauge = thick + 0.5 * STROKE + GAUGE * DEPTH;
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    let (mut lows, mut highs) = (Vec::new(), Vec::new());
    pool.advance_to(BEFORE * PERIOD)?;
    let looks = 40;
    for look in 1..=looks * MEASURED as u32 {
        pool.advance_to(BEFORE * PERIOD + PERIOD * f64::from(look) / f64::from(looks))?;
        let level = level(&pool.water()?.positions, gauge, spacing);
        (low, high) = (low.min(level), high.max(level));
        if look % looks == 0 {
            lows.push(low);
            highs.push(high);
            (low, high) = (f64::INFINITY, f64::NEG_INFINITY);
        }
    }
    let height = (highs.iter().sum::<f64>() - lows.iter().sum::<f64>()) / highs.len() as f64;
    let kh = wave_number(PERIOD, DEPTH) * DEPTH;
    let theory = 2.0 * ((2.0 * kh).cosh() - 1.0) / ((2.0 * kh).sinh() + 2.0 * kh);
    let trial = pool.trial("wave maker");
    let name = format!("H/S at {GAUGE} depths, kh = {kh:.3}");
    Ok(vec![trial.relative(name, height / STROKE, theory, 0.05)])
}

/// The level of the water at x: the area of the particles in a column four spacings wide, over its width.
fn level(positions: &[glam::DVec3], x: f64, spacing: f64) -> f64 {
    // Each particle is a square of water: its share of the column is exact, so that layers do not quantize the level.
    let half = 2.0 * spacing;
    let share = |place: f64| {
        let (low, high) = (place - 0.5 * spacing, place + 0.5 * spacing);
        (high.min(x + half) - low.max(x - half)).max(0.0)
    };
    let area: f64 = positions.iter().map(|p| share(p.x) * spacing).sum();
    area / (2.0 * half)
}

/// Depth D of the channel, m.
const CHANNEL_DEPTH: f64 = 0.21;
/// Width and height of the box, and its initial depth in the water, m.
const BOX: [f64; 2] = [0.3, 0.4];
const DIPPED: f64 = 0.005;
const LENGTH: f64 = 5.7;
/// Positions of the gauges, m: 10 and 19 depths from the box.
const GAUGES: [f64; 2] = [2.4, 4.2];
/// Density of a box of 38.2 kg that is 0.39 m wide, kg/m³: it sinks to the floor.
const DENSITY: f64 = 816.0;
const END: f64 = 2.9;

/// A box that falls at the end of a channel (Scott Russell 1844, Monaghan & Kos 2000): the wave that leaves it is solitary and
/// travels at c² = g (D + H) (Rayleigh 1876; waves half as high as the water is deep are 0.5 % slower). Checks speed and height
/// of the wave between two gauges.
pub fn solitary(context: &CaseContext) -> Outcome {
    let spacing = 0.015;
    let [width, height] = BOX;
    let more = format!(
        r#"
        [[materials]]
        name = "box"
        density = {DENSITY}
        normal_stiffness = 1e6
        friction = 0
        [[blocks]]
        name = "box"
        kind = "box"
        size = [{width}, 1, {height}]
        position = [{}, 0.5, {}]
        material = "box"
        guide = [0, 0, 1]
        "#,
        0.5 * width,
        CHANNEL_DEPTH - DIPPED + 0.5 * height
    );
    let scene = tank::pool([LENGTH, 0.72], spacing, [LENGTH, CHANNEL_DEPTH], &more)?;
    let mut pool = Tank::fill(context, &scene)?;
    let mut crests = [[f64::NEG_INFINITY, 0.0]; 2];
    let mut at = 0.0;
    while at < END {
        at += 0.01;
        pool.advance_to(at)?;
        let positions = pool.water()?.positions;
        let time = pool.simulation.time();
        for (crest, gauge) in crests.iter_mut().zip(GAUGES) {
            let level = level(&positions, gauge, spacing);
            if level > crest[0] {
                *crest = [level, time];
            }
        }
    }
    let [[first, start], [last, stop]] = crests;
    let speed = (GAUGES[1] - GAUGES[0]) / (stop - start);
    let theory = (GRAVITY * 0.5 * (first + last)).sqrt();
    let trial = pool.trial("falling box");
    Ok(vec![
        trial.relative("speed / √(g (D + H))", speed / theory, 1.0, 0.05),
        trial.report("H/D at 10 depths from the box", first / CHANNEL_DEPTH - 1.0),
        trial.at_least(
            "share of H left 9 depths on",
            (last - CHANNEL_DEPTH) / (first - CHANNEL_DEPTH),
            0.8,
        ),
        trial.at_most(
            "box above the floor, spacings",
            (pool.pose(0).centre.z - 0.5 * height) / spacing,
            1.0,
        ),
    ])
}
