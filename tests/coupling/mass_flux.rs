//! The velocity in cells with solid: what crosses a plane is the same everywhere.

use crate::fixture::{World, fluid, material};
use riprap::scene::Field;

/// Water driven by a body force past a turned block that is cut into cells, until it is steady.
#[test]
fn every_plane_carries_the_same_water() {
    let text = format!(
        r#"{}{}
            [numerics]
            time_step = 0.25
            velocity_scale = 0.05
            [[blocks]]
            name = "stone"
            kind = "box"
            size = [2.6, 2.3, 2.9]
            position = [2.6, 2.4, 2.2]
            rotation = {{ axis = [1, 2, 3], angle = 25 }}
            motion = "fixed""#,
        fluid([10, 9, 11], 0.4).replace("viscosity", "acceleration = [2e-3, 0, 0]\nviscosity"),
        material("rock", 2650.0),
    );
    let mut world = World::new(&text);
    world.advance(2400);
    // Full cells reflect what they hold: the mean of two steps.
    let mut planes = [0.0; 10];
    for _ in 0..2 {
        world.advance(1);
        let fields = [Field::Velocity, Field::Density];
        let image = world.rig.wait(world.sim.image(&fields)).unwrap();
        let [u, rho] = [0, 1].map(|n| &image.arrays[n].values);
        for (n, (u, rho)) in u.chunks_exact(3).zip(rho).enumerate() {
            planes[n % 10] += f64::from(u[0] * rho) / (2.0 * 99.0);
        }
    }
    let mean = planes.iter().sum::<f64>() / 10.0;
    println!("{planes:?}");
    for flux in planes {
        // With half of the body force in all cells they differ by half a per cent.
        assert!((flux / mean - 1.0).abs() < 1e-4, "{flux} of {mean}");
    }
}
