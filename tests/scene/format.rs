//! Defaults and every key.

use kit::assert_contains;
use riprap::scene::*;

use crate::{CHANNEL, channel, read};

#[test]
fn a_minimal_scene_has_the_documented_defaults() {
    let scene = read(CHANNEL).unwrap();
    assert_eq!(scene.title, "channel");
    assert_eq!(scene.cells(), [20, 10, 4]);
    assert_eq!(scene.domain.origin, [0.0; 3]);
    assert_eq!(scene.fluid.density, 1000.0);
    assert_eq!(scene.force_field().unwrap(), BodyForce::None);
    assert_eq!(scene.numerics, Numerics::default());
    assert_eq!(scene.numerics.collision, Collision::Hermite);
    assert_eq!(scene.numerics.equilibrium, Equilibrium::Product);
    assert_eq!(scene.numerics.wall_lambda, 0.1875);
    assert_eq!(scene.numerics.odd_rate_floor, None);
    assert!(
        scene
            .boundaries
            .iter()
            .all(|(_, b)| *b == Boundary::Periodic)
    );
    assert_eq!(scene.initial.pressure, InitialPressure::Hydrostatic);
    assert_eq!(scene.output.fields, [Field::Velocity, Field::Pressure]);
    assert!(scene.solids.is_empty() && scene.probes.is_empty());
}

#[test]
fn every_key_is_understood() {
    let scene = read(
        r#"
title = "all of it"
[domain]
origin = [0.1, 0, 0]
size = [0.4, 0.1, 0.02]
cell = 1e-2
[fluid]
density = 998
viscosity = 1e-3
acceleration = [0, "-9.81*cos(0.1)", "1e-3*sin(2*pi*x/0.4)"]
[numerics]
collision = "suga"
equilibrium = "second_order"
eddy_viscosity = "wale"
wale_constant = 0.325
storage = "f16"
lanes = 2
time_step = 1e-5
velocity_scale = 1.0
wall_lambda = 0.25
odd_rate_floor = 0.5
[boundaries]
x_min = { kind = "velocity", velocity = ["1-(y/0.1)^2", 0, 0] }
x_max = { kind = "pressure", pressure = 10, reflecting = true }
y_min = { kind = "wall", velocity = [0.1, 0, 0] }
y_max = { kind = "free_slip" }
z_min = { kind = "periodic" }
[[solids]]
kind = "box"
name = "step"
min = [0.1, 0, 0]
max = [0.2, 0.05, 0.02]
[[solids]]
kind = "half_space"
point = [0.3, 0.01, 0]
normal = [0, 2, 0]
[[solids]]
kind = "sphere"
center = [0.15, 0.05, 0.01]
radius = 0.01
void = true
[initial]
velocity = ["x", 0, 0]
pressure = "100*x"
[run]
duration = 1.0
checkpoint_every = 0.5
[output]
every = 0.1
fields = ["velocity", "pressure", "density", "eddy_viscosity", "q_criterion", "vorticity", "solid"]
[[output.slices]]
name = "mid"
axis = "z"
position = 0.01
field = "speed"
streamlines = true
range = [0, 1]
every = 0.2
[[output.histories]]
quantities = ["kinetic_energy", "enstrophy", "mass", "momentum_x", "momentum_y", "momentum_z", "max_speed"]
every = 0.01
[[probes]]
name = "p"
kind = "point"
at = [0.2, 0.05, 0.01]
fields = ["pressure"]
every = 0.01
[[probes]]
name = "l"
kind = "line"
from = [0.1, 0.05, 0.01]
to = [0.5, 0.05, 0.01]
count = 11
[[probes]]
name = "s"
kind = "plane"
axis = "x"
position = 0.3
[[probes]]
name = "b"
kind = "box"
min = [0.1, 0, 0]
max = [0.2, 0.1, 0.02]
[[probes]]
name = "f"
kind = "face"
min = [0.2, 0, 0]
max = [0.3, 0.1, 0.02]
normal = "+x"
"#,
    )
    .unwrap();
    assert_eq!(scene.title, "all of it");
    assert_eq!(scene.numerics.lanes, Some(2));
    assert!(scene.solids[2].void);
    assert_eq!(scene.solids[0].name.as_deref(), Some("step"));
    assert_eq!(scene.output.slices[0].range, Some([0.0, 1.0]));
    assert_eq!(scene.output.histories[0].quantities.len(), 7);
    assert_eq!(scene.probes[1].fields, [Field::Velocity, Field::Pressure]);
    let ProbePlace::Face { normal, .. } = scene.probes[4].place else {
        panic!("the last probe is a face");
    };
    assert_eq!((normal.axis(), normal.sign()), (Axis::X, 1));
    assert_eq!(
        scene.boundaries.x_max,
        Boundary::Pressure {
            pressure: 10.0.into(),
            reflecting: true
        }
    );
    assert!(matches!(scene.force_field().unwrap(), BodyForce::Field(_)));
}

#[test]
fn the_schema_describes_every_key_with_its_unit() {
    let schema = serde_json::to_string(&Scene::schema()).unwrap();
    for part in [
        "\"additionalProperties\":false",
        "half_space",
        "free_slip",
        "Kinematic viscosity, m²/s.",
        "Time step, s.",
        "q_criterion",
        "\"+x\"",
        "dodecahedron",
        "Density, kg/m³.",
        "Mass damping α, 1/s",
        "rock_masses",
        "tensile_strength",
        "persistence",
        "Distance Δx of particles at the start, m.",
        "run_up",
    ] {
        assert!(schema.contains(part), "{part}");
    }
    assert!(!schema.contains("\"dir\""));
}

#[test]
fn a_run_in_seconds_is_the_nearest_number_of_steps() {
    let scene = channel("[numerics]\ntime_step = 1e-3\n").unwrap();
    let units = riprap::units::Units::of(&scene).unwrap();
    assert_eq!(scene.run.step_count(&units), 10);
    let run = Run {
        duration: Some(0.0996),
        ..Run::default()
    };
    assert_eq!(run.step_count(&units), 100);
    assert!((run.duration(&units) - 0.1).abs() < 1e-12);
}

/// Slices and traces show the fluid.
#[test]
fn a_view_has_slices_and_traces() {
    let scene = channel(
        "[[views]]\nname = \"v\"\ntraces = 10\nslices = [{ axis = \"y\", position = 0.004, field = \"pressure\", \
         range = [-1, 1] }, { axis = \"z\", field = \"speed\" }]\n",
    );
    let view = &scene.unwrap().views[0];
    assert!(view.shows_fluid() && view.traces == 10);
    let [first, second] = &view.slices[..] else {
        panic!("{:?}", view.slices);
    };
    assert_eq!((first.axis, first.position), (Axis::Y, Some(0.004)));
    assert_eq!(
        (first.field, first.range),
        (SliceField::Pressure, Some([-1.0, 1.0]))
    );
    assert_eq!((second.position, second.range), (None, None));
}

#[test]
fn formulas_take_series_from_files_beside_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("flow.csv");
    let write = |text: &str| std::fs::write(&file, text).unwrap();
    let scene = r#"
        domain = { size = [1, 1, 1], cell = 0.1 }
        fluid = { viscosity = 1e-2 }
        numerics.time_step = 0.01
        run.steps = 1
        [boundaries]
        x_min = { kind = "velocity", velocity = ["0.5*interpolate(t, 'flow.csv')", 0, 0] }
        x_max = { kind = "pressure" }
    "#;
    let read_from = |scene: &str| Scene::from_toml(scene, folder.path(), "river.toml");
    let read = || read_from(scene);
    write("time,speed\n0,1\n10,2\n20,0.5\n\n");
    let read_scene = read().unwrap();
    let titled = scene.replace(
        "domain =",
        "title = \"Don't interpolate(t)\"\n        domain =",
    );
    assert_eq!(read_from(&titled).unwrap().title, "Don't interpolate(t)");
    let Boundary::Velocity { velocity, .. } = read_scene.boundaries.face(Face::XMin) else {
        panic!("a velocity inlet")
    };
    assert_eq!(velocity[0].eval(0.0, 0.0, 0.0, 5.0), 0.75);
    assert_eq!(velocity[0].eval(0.0, 0.0, 0.0, 99.0), 0.25);
    for (text, parts) in [
        (
            "0,1\n10,2\n",
            vec!["river.toml:7:", "first line is of numbers"],
        ),
        (
            "time,a,b\n0,1,2\n",
            vec!["boundaries.x_min.velocity", "3 columns"],
        ),
        ("time,a\n0,one\n", vec!["line 2", "`one` is not a number"]),
        (
            "time,a\n5,1\n0,1\n",
            vec!["flow.csv: time ascends", "row 2", "0 follows 5"],
        ),
        ("time,a\n0,1\n1,NaN\n", vec!["flow.csv: row 2", "finite"]),
        ("time,a\n5,1\n", vec!["at least two points"]),
        ("time,a\n", vec!["flow.csv: it has no numbers"]),
        ("", vec!["flow.csv: it is empty"]),
    ] {
        write(text);
        assert_contains(read().unwrap_err().to_string(), &parts);
    }
    std::fs::remove_file(&file).unwrap();
    assert_contains(
        read().unwrap_err().to_string(),
        &["river.toml:7:", "flow.csv"],
    );
}
