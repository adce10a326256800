//! Faces with a pressure that changes over time, and hydrostatic ones.

use kit::{Rig, assert_near};
use riprap::{output::ImageData, scene::Field, simulation::Simulation};

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

fn image(rig: &Rig, simulation: &mut Simulation) -> ImageData {
    let read = simulation.image(&[Field::Pressure, Field::Velocity]);
    rig.wait(read).unwrap()
}

fn mean_pressure(image: &ImageData) -> f64 {
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
        // The level is at 37.5 Pa. A face whose pressure is held only on average lags behind it.
        let around = if reflecting { 25.0..50.0 } else { 1.0..37.5 };
        assert!(around.contains(&halfway), "{reflecting}: {halfway}");
        let state = rig.wait(whole.checkpoint()).unwrap();
        rig.wait(whole.advance(1750)).unwrap();
        let found = image(&rig, &mut whole);
        // Sound persists for a while in the basin, whose other end reflects it.
        assert_near(
            mean_pressure(&found),
            100.0,
            if reflecting { 12.0 } else { 3.0 },
        );
        let mut fresh = rig.simulation(&scene).unwrap();
        fresh.restore(&state).unwrap();
        rig.wait(fresh.advance(1750)).unwrap();
        assert_eq!(image(&rig, &mut fresh), found);
        // A constant formula gives the same as a number.
        let run = |pressure: &str| {
            let scene = kit::scene::read(&basin(pressure, reflecting)).unwrap();
            let mut simulation = rig.simulation(&scene).unwrap();
            rig.wait(simulation.advance(50)).unwrap();
            image(&rig, &mut simulation)
        };
        assert_eq!(run("\"30 + 0*t\""), run("30"));
    }
}

/// A flow past a step, with the acceleration `gravity` along z.
fn past_a_step(gravity: f64, reflecting: bool) -> String {
    format!(
        r#"
        domain = {{ size = [2.4, 0.4, 1.2], cell = 0.1 }}
        fluid = {{ viscosity = 0.02, density = 1000, acceleration = [0, 0, {gravity}] }}
        numerics = {{ time_step = 0.01, velocity_scale = 0.4 }}
        run.steps = 1000
        [boundaries]
        x_min = {{ kind = "velocity", velocity = [0.3, 0, 0] }}
        x_max = {{ kind = "pressure", reflecting = {reflecting} }}
        z_min = {{ kind = "wall" }}
        z_max = {{ kind = "free_slip" }}
        [initial]
        velocity = [0.3, 0, 0]
        [[solids]]
        name = "step"
        kind = "box"
        min = [0.6, 0, 0]
        max = [1.0, 0.4, 0.4]
        "#
    )
}

/// The water is denser by 0.2 % at the bottom, and the flow equals that without weight.
#[test]
fn an_outlet_holds_hydrostatic_pressure_where_water_is_heavy() {
    let rig = Rig::new();
    for reflecting in [true, false] {
        let [light, heavy] = [0.0, -0.05].map(|gravity| {
            let scene = kit::scene::read(&past_a_step(gravity, reflecting)).unwrap();
            let mut simulation = rig.simulation(&scene).unwrap();
            rig.wait(simulation.advance(1000)).unwrap();
            image(&rig, &mut simulation)
        });
        let velocity = |image: &ImageData| image.array("velocity").unwrap().values.clone();
        let pairs = velocity(&light).into_iter().zip(velocity(&heavy));
        let largest = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(largest < 0.003, "{reflecting}: {largest} m/s of 0.3");
        // Above the outlet's middle at 0.6 m the pressure is lower by the weight between.
        let at = |image: &ImageData, z: f64| image.sample("pressure", [2.3, 0.2, z]).unwrap()[0];
        for z in [0.15, 0.55, 1.05] {
            let weight = at(&heavy, z) - at(&light, z);
            assert_near(weight, 1000.0 * 0.05 * (0.6 - z), 1.0);
        }
    }
}

/// An outlet that lets waves out reflects a part of a slow oscillation: without reflection its amplitude would be that of the inlet
/// everywhere, and at an outlet of constant pressure cos(kL/4)/cos(kL) = 1.2 times that, for kL = 0.6.
#[test]
fn an_outlet_reflects_a_part_of_a_slow_oscillation() {
    const RATE: f64 = 0.866;
    let scene = format!(
        r#"
        domain = {{ size = [8, 0.4, 0.4], cell = 0.1 }}
        fluid.viscosity = 0.01
        numerics = {{ time_step = 0.005, velocity_scale = 1.1 }}
        initial.velocity = [1, 0, 0]
        run.steps = 1
        [boundaries]
        x_min = {{ kind = "velocity", velocity = ["1 + 0.1*sin({RATE}*t)", 0, 0] }}
        x_max = {{ kind = "pressure" }}
        "#
    );
    let rig = Rig::new();
    let mut simulation = rig.simulation(&kit::scene::read(&scene).unwrap()).unwrap();
    let period = std::f64::consts::TAU / (RATE * 0.005);
    rig.wait(simulation.advance((5.0 * period) as u64)).unwrap();
    let [mut least, mut most] = [f32::INFINITY, f32::NEG_INFINITY];
    for _ in 0..20 {
        rig.wait(simulation.advance((period / 20.0) as u64))
            .unwrap();
        let image = image(&rig, &mut simulation);
        // At three quarters of the length.
        let velocity = image.array("velocity").unwrap().values[3 * ((4 + 1) * 80 + 60)];
        (least, most) = (least.min(velocity), most.max(velocity));
    }
    let amplitude = 0.5 * (most - least) / 0.1;
    assert!((1.1..1.3).contains(&amplitude), "{amplitude}");
}
