//! A box that falls at the end of a channel (Scott Russell 1844, Monaghan & Kos 2000): the wave that leaves it is solitary,
//! and runs at c² = g (D + H) (Rayleigh 1876; waves half as high as the water is deep are 0.5 % slower).

use super::maker::level;
use crate::validate::{
    Outcome, Stand,
    tank::{self, GRAVITY, Tank},
};

/// Depth D, m.
const DEPTH: f64 = 0.21;
/// Width and height of the box, and how deep it is in the water at the start, m.
const BOX: [f64; 2] = [0.3, 0.4];
const DIPPED: f64 = 0.005;
const LENGTH: f64 = 5.7;
/// Where the crest is looked for, m: 10 and 19 depths from the box.
const GAUGES: [f64; 2] = [2.4, 4.2];
/// Of 38.2 kg that are 0.39 m wide, kg/m³: it sinks to the floor.
const DENSITY: f64 = 816.0;
const END: f64 = 2.9;

/// Speed and height of the wave between two gauges.
pub fn run(stand: &Stand) -> Outcome {
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
        DEPTH - DIPPED + 0.5 * height
    );
    let scene = tank::pool([LENGTH, 0.72], spacing, [LENGTH, DEPTH], &more)?;
    let mut pool = Tank::fill(stand, &scene)?;
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
        trial.report("H/D at 10 depths from the box", first / DEPTH - 1.0),
        trial.at_least(
            "share of H left 9 depths on",
            (last - DEPTH) / (first - DEPTH),
            0.8,
        ),
        trial.at_most(
            "box above the floor, spacings",
            (pool.pose(0).centre.z - 0.5 * height) / spacing,
            1.0,
        ),
    ])
}
