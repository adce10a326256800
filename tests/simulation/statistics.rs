//! Statistics of the fields of a scene: times and content of samples, over restarts, with blocks.

use kit::Rig;
use riprap::{
    output::ImageData,
    scene::{Boundary, Field, Scene},
    simulation::Simulation,
    wgpu,
};

/// Mean velocity of the inlet, m/s.
const SPEED: f64 = 0.3;

const FIELDS: [Field; 5] = [
    Field::MeanVelocity,
    Field::MeanPressure,
    Field::PressureRms,
    Field::ReynoldsStress,
    Field::TurbulentKineticEnergy,
];

/// A block in a channel with an oscillating inlet; samples are the steps 4, 7, 10, …
fn scene(statistics: bool, motion: &str) -> Scene {
    let with = match statistics {
        true => "[statistics]\nfrom = 0.04\nevery = 0.03\n[output]\nfields = [\"mean_velocity\"]",
        false => "",
    };
    kit::scene::read(&format!(
        r#"
        domain = {{ size = [1.6, 0.9, 1.0], cell = 0.1 }}
        fluid = {{ viscosity = 1e-2, density = 1000 }}
        numerics.time_step = 0.01
        run.steps = 60
        [boundaries]
        x_min = {{ kind = "velocity", velocity = ["0.3 + 0.1 * sin(60 * t)", 0, 0] }}
        x_max = {{ kind = "pressure" }}
        z_min = {{ kind = "wall" }}
        z_max = {{ kind = "free_slip" }}
        [[materials]]
        name = "rock"
        density = 2650
        normal_stiffness = 1e6
        friction = 30
        [rock]
        gravity = [0, 0, -9.81]
        [coupling]
        interval = 2
        [[blocks]]
        kind = "box"
        size = [0.3, 0.3, 0.3]
        position = [0.6, 0.45, 0.5]
        motion = "{motion}"
        {with}
        "#
    ))
    .unwrap()
}

fn simulation(rig: &Rig, statistics: bool, motion: &str) -> Simulation {
    rig.simulation(&scene(statistics, motion)).unwrap()
}

fn image(rig: &Rig, simulation: &mut Simulation, fields: &[Field]) -> ImageData {
    rig.wait(simulation.image(fields)).unwrap()
}

fn values(image: &ImageData, field: Field) -> &[f32] {
    &image.array(field.name()).unwrap().values
}

#[test]
fn fields_over_time_are_those_of_the_states_that_are_samples() {
    let all = Rig::new();
    // The last is the number of bindings of this scene, so that no kernel of a step binds the sums of statistics.
    let limits = wgpu::Limits {
        max_storage_buffers_per_shader_stage: 8,
        ..all.device.limits()
    };
    // The density differs from step to step.
    compare(&all, "fixed", 1e-3);
    compare(&all, "free", f64::INFINITY);
    compare(&Rig::with_limits(limits), "free", 0.0);
}

/// `by_step`: how far a sample near the block may differ from the fields, relative to the velocity of the inlet. Fields show the
/// block of the step before a state, samples that of the step after it.
fn compare(rig: &Rig, motion: &str, by_step: f64) {
    let simulation = |rig, statistics| simulation(rig, statistics, motion);
    let mut whole = simulation(rig, true);
    let mut cut = simulation(rig, true);
    let mut plain = simulation(rig, false);
    rig.wait(whole.advance(3)).unwrap();
    assert_eq!(whole.samples(), 0);
    assert!(values(&image(rig, &mut whole, &FIELDS), Field::MeanPressure)[0].is_nan());
    let mut states = Vec::new();
    for step in (4..=40).step_by(3) {
        rig.wait(plain.advance(step - plain.step())).unwrap();
        let fields = [Field::Velocity, Field::Pressure, Field::Solid];
        states.push(image(rig, &mut plain, &fields));
    }
    // The step after a state adds it.
    rig.wait(plain.advance(1)).unwrap();
    rig.wait(whole.advance(41 - 3)).unwrap();
    assert_eq!(whole.samples(), states.len() as u64);
    let found = image(rig, &mut whole, &FIELDS);

    let count = states.len() as f64;
    let mean = |of: &dyn Fn(&ImageData) -> f64| states.iter().map(of).sum::<f64>() / count;
    let u = |state: &ImageData, at: usize| f64::from(values(state, Field::Velocity)[at]);
    let p = |state: &ImageData, at: usize| f64::from(values(state, Field::Pressure)[at]);
    for cell in 0..found.cell_count() {
        let means = [0, 1, 2].map(|a| mean(&|state| u(state, 3 * cell + a)));
        // A block also acts on cells that it does not quite reach.
        let place = |n: usize| [n % 16, n / 16 % 9, n / (16 * 9)];
        let adjacent = |of: &usize| (0..3).all(|a| place(cell)[a].abs_diff(place(*of)[a]) <= 1);
        let around: Vec<_> = (0..found.cell_count()).filter(adjacent).collect();
        let solid = |state: &ImageData, of: &usize| values(state, Field::Solid)[*of] > 0.0;
        let filled = (states.iter()).any(|state| around.iter().any(|of| solid(state, of)));
        let [of_mean, of_product] = match filled {
            true => [1e-6 + by_step * SPEED, 2e-7 + by_step * SPEED.powi(2)],
            false => [1e-6, 2e-7],
        };
        for a in 0..3 {
            let of = f64::from(values(&found, Field::MeanVelocity)[3 * cell + a]);
            assert!(
                (of - means[a]).abs() < of_mean,
                "{cell} {a}: {of} for {}",
                means[a]
            );
        }
        let product = |a: usize, b: usize| {
            mean(&|state| (u(state, 3 * cell + a) - means[a]) * (u(state, 3 * cell + b) - means[b]))
        };
        let pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)];
        for (k, (a, b)) in pairs.into_iter().enumerate() {
            let of = f64::from(values(&found, Field::ReynoldsStress)[6 * cell + k]);
            assert!(
                (of - product(a, b)).abs() < of_product,
                "{cell} {k}: {of} for {}",
                product(a, b)
            );
        }
        let energy = 0.5 * (product(0, 0) + product(1, 1) + product(2, 2));
        let of = f64::from(values(&found, Field::TurbulentKineticEnergy)[cell]);
        assert!(
            (of - energy).abs() < 2.0 * of_product,
            "{cell}: {of} for {energy}"
        );
        let pressure = mean(&|state| p(state, cell));
        let of = f64::from(values(&found, Field::MeanPressure)[cell]);
        assert!(
            (of - pressure).abs() < 1e-5 * pressure.abs().max(100.0),
            "{cell}: {of} for {pressure}"
        );
        let rms = mean(&|state| (p(state, cell) - pressure).powi(2)).sqrt();
        let of = f64::from(values(&found, Field::PressureRms)[cell]);
        assert!(
            (of - rms).abs() < 1e-4 * rms.max(10.0),
            "{cell}: {of} for {rms}"
        );
    }

    // The flow is bitwise the same, and an interrupted run continues with the same numbers.
    let [one, other] = [&mut whole, &mut plain].map(|of| image(rig, of, &[Field::Velocity]));
    assert_eq!(one, other);
    rig.wait(cut.advance(17)).unwrap();
    let state = rig.wait(cut.checkpoint()).unwrap();
    let mut fresh = simulation(rig, true);
    fresh.restore(&state).unwrap();
    rig.wait(fresh.advance(24)).unwrap();
    assert_eq!(image(rig, &mut fresh, &FIELDS), found);
    // A state without statistics, or with other samples, starts them anew.
    let none = rig.wait(plain.checkpoint()).unwrap();
    fresh.restore(&none).unwrap();
    assert_eq!(fresh.samples(), 0);
}

/// Samples between two exchanges, with a constant inlet, change nothing.
#[test]
fn samples_between_exchanges_leave_the_flow_and_the_blocks_as_they_are() {
    let rig = Rig::new();
    let run = |statistics: bool| {
        let mut scene = scene(statistics, "free");
        scene.coupling.interval = 5;
        if let Boundary::Velocity { velocity, .. } = &mut scene.boundaries.x_min {
            velocity[0] = 0.3.into();
        }
        let mut simulation = rig.simulation(&scene).unwrap();
        rig.wait(simulation.advance(33)).unwrap();
        let poses = simulation.rock().unwrap().poses().to_vec();
        let image = image(&rig, &mut simulation, &[Field::Velocity, Field::Pressure]);
        (image, format!("{poses:?}"), simulation.samples())
    };
    let (with, without) = (run(true), run(false));
    assert_eq!((with.2, without.2), (10, 0));
    assert_eq!(with.0, without.0);
    assert_eq!(with.1, without.1);
}
