//! A piston that makes waves: H/S = 2 (cosh 2kh − 1)/(sinh 2kh + 2kh) (Dean & Dalrymple 1991).

use crate::validate::{
    Outcome, Stand,
    tank::{self, GRAVITY, Tank},
};
use std::f64::consts::PI;

const DEPTH: f64 = 1.0;
const STROKE: f64 = 0.1;
const PERIOD: f64 = 2.0;
/// From the mean place of the piston to the gauge, depths.
const GAUGE: f64 = 3.0;
/// Periods after which the wave at the gauge is whole, and those over which it is measured; the wave that the far
/// wall sends back has not come by then.
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

/// Height of the waves over the stroke.
pub fn run(stand: &Stand) -> Outcome {
    let layers = 20;
    let spacing = DEPTH / f64::from(layers);
    // The fastest waves run at √(gH): from the piston to the far wall and back to the gauge.
    let way = (BEFORE + MEASURED) * PERIOD * (GRAVITY * DEPTH).sqrt();
    let length = (0.5 * (way + GAUGE * DEPTH) / spacing).ceil() * spacing;
    // The piston starts at one end of its stroke, with its face half a spacing before water at the lattice.
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
        // Waves of a tenth of the depth move far slower than a fall through it.
        particles.largest_speed = Some((GRAVITY * DEPTH).sqrt());
    }
    let mut pool = Tank::fill(stand, &scene)?;
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
pub fn level(positions: &[glam::DVec3], x: f64, spacing: f64) -> f64 {
    // Each particle is a square of water: its share of the column is exact, so that the level is not one of layers.
    let half = 2.0 * spacing;
    let share = |place: f64| {
        let (low, high) = (place - 0.5 * spacing, place + 0.5 * spacing);
        (high.min(x + half) - low.max(x - half)).max(0.0)
    };
    let area: f64 = positions.iter().map(|p| share(p.x) * spacing).sum();
    area / (2.0 * half)
}
