//! Faces whose pressure changes in time.

use kit::{Rig, assert_near};
use riprap::{output::Image, scene::Field, simulation::Simulation};

/// A basin with a pressure face at its end, which rises from 1 s on by 100 Pa in 4 s.
fn basin(pressure: &str, reflecting: bool) -> String {
    format!(
        r#"
        domain = {{ size = [2, 0.4, 0.4], cell = 0.1 }}
        fluid = {{ viscosity = 0.02, density = 1000 }}
        numerics.time_step = 0.01
        run.steps = 1000
        [boundaries]
        x_min = {{ kind = "free_slip" }}
        x_max = {{ kind = "pressure", pressure = {pressure}, reflecting = {reflecting} }}
        "#
    )
}

fn image(rig: &Rig, simulation: &mut Simulation) -> Image {
    let read = simulation.image(&[Field::Pressure, Field::Velocity]);
    rig.wait(read).unwrap()
}

fn mean_pressure(image: &Image) -> f64 {
    let values = &image.array("pressure").unwrap().values;
    values.iter().map(|p| f64::from(*p)).sum::<f64>() / values.len() as f64
}

#[test]
fn a_basin_follows_the_level_at_its_end() {
    let rig = Rig::new();
    let rises = "\"interpolate(t, 1, 0, 5, 100)\"";
    for reflecting in [true, false] {
        let scene = kit::scene::read(&basin(rises, reflecting)).unwrap();
        let mut whole = rig.simulation(&scene).unwrap();
        rig.wait(whole.advance(100)).unwrap();
        assert_near(mean_pressure(&image(&rig, &mut whole)), 0.0, 1e-3);
        rig.wait(whole.advance(150)).unwrap();
        let halfway = mean_pressure(&image(&rig, &mut whole));
        // The level is at 37.5 Pa. A face that is held on average only lags behind it.
        let around = if reflecting { 25.0..50.0 } else { 1.0..37.5 };
        assert!(around.contains(&halfway), "{reflecting}: {halfway}");
        let state = rig.wait(whole.checkpoint()).unwrap();
        rig.wait(whole.advance(1750)).unwrap();
        let found = image(&rig, &mut whole);
        // Sound goes on for a while in the basin, whose other end returns it.
        assert_near(
            mean_pressure(&found),
            100.0,
            if reflecting { 12.0 } else { 3.0 },
        );
        let mut fresh = rig.simulation(&scene).unwrap();
        fresh.restore(&state).unwrap();
        rig.wait(fresh.advance(1750)).unwrap();
        assert_eq!(image(&rig, &mut fresh), found);
        // What does not change is what it was as a number.
        let run = |pressure: &str| {
            let scene = kit::scene::read(&basin(pressure, reflecting)).unwrap();
            let mut simulation = rig.simulation(&scene).unwrap();
            rig.wait(simulation.advance(50)).unwrap();
            image(&rig, &mut simulation)
        };
        assert_eq!(run("\"30 + 0*t\""), run("30"));
    }
}
