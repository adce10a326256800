//! A column on an incline topples if tan α > b/h.

use crate::fixture::{blocks, cuboid, joint, run, settled, setup, slope};
use glam::DVec3;
use riprap::rock::{Block, Setup};

/// A 1 m × 1 m × 2 m column on an incline of `alpha` degrees. It is stiff: a degree before the threshold a strip of
/// 65 mm carries it, which must not give way by a degree itself.
pub fn column(alpha: f64) -> Setup {
    let turn = slope(alpha.to_radians());
    let plate = Block::new("plate", cuboid(5.0, 5.0, 1.0), turn * DVec3::Z * -0.5);
    let column = Block::new("column", cuboid(1.0, 1.0, 2.0), turn * DVec3::Z);
    setup(
        vec![plate.fixed().turned(turn), column.turned(turn)],
        joint(4e10, 50.0),
    )
}

/// Tilt of a 1 m × 1 m × 2 m column against its incline of `alpha` degrees, rad, 1 s after it was let go.
///
/// It is let go slowly: dropped on its base it would rock past its edge.
fn tilt(alpha: f64) -> f64 {
    let turn = slope(alpha.to_radians());
    let setup = column(alpha);
    let leaning = settled(&setup, 20.0, 0.3);
    let mut blocks = blocks(setup);
    blocks.restore(&leaning).expect("the same blocks");
    run(&mut blocks, leaning.time() + 1.0);
    blocks.rotation(1).angle_between(turn)
}

#[test]
fn it_topples_above_b_over_h_and_stands_below() {
    let threshold = 0.5f64.atan().to_degrees();
    let [below, above] = [threshold - 1.0, threshold + 1.0].map(tilt);
    // Below, the strip is pressed by θ = 2W/(k s²) = 0.5 mrad; above, the column falls by 60 mrad.
    assert!(below < 2e-3, "stands: {below} rad");
    assert!(above > 2e-2, "topples: {above} rad");
}
