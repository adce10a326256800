//! A block on an incline of 30°: s = ½gt²(sin α − cos α tan φ); it sticks if φ ≥ α.

use super::{
    Outcome, Stand,
    rock::{DENSITY, G, Rock, cuboid, joint, setup, slope},
};
use glam::DVec3;
use riprap::rock::{Block, Setup};

const ALPHA: f64 = 30.0;
const STIFFNESS: f64 = 1e8;
const HEIGHT: f64 = 0.4;

/// The block, pressed in as it will be.
fn on_incline(phi: f64) -> anyhow::Result<Setup> {
    let turn = slope(ALPHA);
    let pressed = DENSITY * HEIGHT * G * ALPHA.to_radians().cos() / STIFFNESS;
    let plate = cuboid(12.0, 3.0, 1.0)?;
    let plate = Block::new("plate", plate, turn * DVec3::new(4.0, 0.0, -0.5));
    let at = turn * DVec3::Z * (0.5 * HEIGHT - pressed);
    let block = Block::new("block", cuboid(1.0, 1.0, HEIGHT)?, at);
    let list = vec![plate.fixed().turned(turn), block.turned(turn)];
    Ok(setup(list, joint(STIFFNESS, phi)))
}

/// Slides at φ = 20°, slips at 29.9°, holds at 30.1°.
pub fn run(_: &Stand) -> Outcome {
    let mut records = Vec::new();
    for phi in [20.0f64, 29.9, 30.1] {
        let what = format!("α = {ALPHA}°, φ = {phi}°, k = {STIFFNESS:.0e} Pa/m");
        // Held by friction until it carries its weight: only then it gets its friction angle.
        let mut rock = Rock::from_rest(on_incline(60.0)?, 100.0, 0.4, on_incline(phi)?, what)?;
        let start = rock.blocks.poses()[1].centre;
        rock.run(1.0)?;
        let way = (rock.blocks.poses()[1].centre - start).dot(slope(ALPHA) * DVec3::X);
        let [alpha, angle] = [ALPHA, phi].map(f64::to_radians);
        let exact = 0.5 * G * (alpha.sin() - alpha.cos() * angle.tan());
        let trial = rock.trial();
        records.push(if phi < 25.0 {
            trial.relative("way after 1 s, m", way, exact, 1e-3)
        } else if phi < ALPHA {
            trial.relative("way after 1 s, m", way, exact, 1e-2)
        } else {
            trial.at_most("way after 1 s, m", way.abs(), 1e-6)
        });
    }
    Ok(records)
}
