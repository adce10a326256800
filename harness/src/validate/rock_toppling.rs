//! A column on an incline topples if tan α > b/h.

use super::{
    Outcome, Stand,
    rock::{Rock, cuboid, joint, setup, slope},
};
use glam::DVec3;
use riprap::rock::Block;

/// At 0.3° from the threshold a strip of 20 mm carries the column of 49 kN: it must not give way by more
/// than a tenth of that angle, θ = 2W/(k s²).
const STIFFNESS: f64 = 4e11;

/// A column of 1 m × 1 m × 2 m, 0.3° below and above.
pub fn run(_: &Stand) -> Outcome {
    let threshold = 0.5f64.atan().to_degrees();
    let mut records = Vec::new();
    for off in [-0.3, 0.3] {
        let alpha = threshold + off;
        let turn = slope(alpha);
        let plate = Block::new("plate", cuboid(5.0, 5.0, 1.0)?, turn * DVec3::Z * -0.5);
        let column = Block::new("column", cuboid(1.0, 1.0, 2.0)?, turn * DVec3::Z);
        let list = vec![plate.fixed().turned(turn), column.turned(turn)];
        let setup = setup(list, joint(STIFFNESS, 50.0));
        let what = format!("1 x 1 x 2 m at {alpha:.3}°, k = {STIFFNESS:.0e} Pa/m");
        let mut rock = Rock::from_rest(setup.clone(), 20.0, 0.3, setup, what)?;
        rock.run(1.0)?;
        let tilt = rock.blocks.rotation(1).angle_between(turn);
        let trial = rock.trial();
        // It falls by ½ · 0.034 rad/s² · t² and more; it stands at 1 mrad.
        records.push(if off < 0.0 {
            trial.at_most("tilt after 1 s, stands, rad", tilt, 3e-3)
        } else {
            trial.at_least("tilt after 1 s, topples, rad", tilt, 1e-2)
        });
    }
    Ok(records)
}
