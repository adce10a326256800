//! Warnings whose numbers follow from a formula; those from keys alone are in `refusals.txt`.

use riprap::Result;
use riprap::scene::Advice;
use riprap::units::Units;

use crate::{channel, read};

/// A block in a fluid; the weight of both acts along z.
pub const STONE: &str = r#"
[domain]
size = [0.32, 0.16, 0.16]
cell = 0.01
[fluid]
viscosity = 1e-3
acceleration = [0, 0, -9.81]
[numerics]
velocity_scale = 1
[coupling]
hold = 0
[rock]
gravity = [0, 0, -9.81]
[boundaries]
z_min = { kind = "wall" }
z_max = { kind = "wall" }
[[materials]]
name = "r"
density = 2650
normal_stiffness = 1e9
friction = 30
[[blocks]]
name = "b"
kind = "box"
size = [0.05, 0.05, 0.05]
position = [0.1, 0.08, 0.05]
[run]
duration = 0.2
[[probes]]
name = "p"
kind = "block"
block = "b"
every = 0.002
"#;

#[track_caller]
fn warned(advice: Result<Advice>, parts: &[&str]) {
    let advice = advice.unwrap();
    assert_eq!(advice.len(), 1, "{advice:?}");
    let words = advice[0].to_string();
    for part in parts {
        assert!(words.contains(part), "`{part}` is not in: {words}");
    }
}

#[test]
fn water_that_given_pressures_compress_is_warned_of() {
    // c² = Δx²/(3 Δt²) = 3.33e-5 m²/s² at 1 mm and 0.1 s: 0.01 Pa is 0.3 of ρ c², and 5 % at a step shorter by √6.
    let duct = |pressure: f64, initial: &str| {
        let scene = read(&format!(
            "[domain]\nsize = [0.02, 0.01, 0.01]\ncell = 1e-3\n[run]\nsteps = 1\n\
             [fluid]\nviscosity = 1e-6\n[initial]\n{initial}\n[boundaries]\n\
             x_min = {{ kind = \"pressure\", pressure = {pressure} }}\nx_max = {{ kind = \"pressure\" }}\n\
             [numerics]\ntime_step = 0.1\nvelocity_scale = 1e-4\n"
        ))
        .unwrap();
        let units = Units::of(&scene).unwrap();
        (scene.advise(&units), scene.compression(&units).unwrap())
    };
    let (advice, compression) = duct(0.01, "");
    warned(
        advice,
        &[
            "boundaries",
            "30.0 %",
            "half of that",
            "time_step ≤ 4.082e-2 s",
        ],
    );
    assert!((compression - 0.3).abs() < 1e-9, "{compression}");
    assert_eq!(duct(1e-3, "").0.unwrap(), []);
    let waves = "pressure = \"0.005*sin(100*pi*x)\"";
    warned(duct(0.0, waves).0, &["initial.pressure", "time_step ≤"]);
    warned(duct(0.01, waves).0, &["boundaries"]);
}

/// An inlet that grows from 1 to 3 m/s within the run.
#[test]
fn the_time_step_follows_from_the_fastest_time_of_an_inlet() {
    let scene = |end: &str| {
        read(&format!(
            "[domain]\nsize = [0.02, 0.01, 0.01]\ncell = 1e-3\n[run]\n{end}\n[fluid]\nviscosity = 1e-3\n[boundaries]\n\
             x_min = {{ kind = \"velocity\", velocity = [\"1 + t\", 0, 0] }}\nx_max = {{ kind = \"pressure\" }}\n"
        ))
        .unwrap()
    };
    assert_eq!(scene("duration = 2").velocity_scale().unwrap(), 3.0);
    // How long steps are is not known.
    assert_eq!(scene("steps = 10").velocity_scale().unwrap(), 1.0);
}

/// τ − ½ = 3 ν Δt/Δx² is 0.019 and 0.021.
#[test]
fn one_magic_parameter_at_a_low_viscosity_is_warned_of() {
    let advice = |viscosity: f64| {
        let scene = read(&format!(
            "[domain]\nsize = [0.02, 0.01, 0.01]\ncell = 1e-3\n[run]\nsteps = 1\n[fluid]\nviscosity = {viscosity}\n\
             [numerics]\ntime_step = 1e-3\nvelocity_scale = 1e-3\nlambda = 0.1875\n"
        ))
        .unwrap();
        scene.advise(&Units::of(&scene).unwrap())
    };
    warned(
        advice(0.019e-3 / 3.0),
        &["numerics.lambda", "6.667e-6 m²/s"],
    );
    assert_eq!(advice(0.021e-3 / 3.0).unwrap(), []);
}

/// With 16-bit storage the friction of a surface that cuts cells is not that of a wall.
#[test]
fn a_wall_model_without_effect_on_an_exact_surface_is_told() {
    let bed = |surface: &str, storage: &str| {
        let scene = channel(&format!(
            "
            [numerics]
            storage = \"{storage}\"
            eddy_viscosity = \"wale\"
            wall_model = \"reichardt\"
            velocity_scale = 0.05
            [boundaries]
            y_min = {{ kind = \"wall\" }}
            y_max = {{ kind = \"wall\" }}
            [[solids]]
            kind = \"box\"
            min = [0, 0, 0]
            max = [2e-3, 2.5e-3, 2e-3]
            surface = \"{surface}\"
            "
        ))
        .unwrap();
        scene.advise(&Units::of(&scene).unwrap()).unwrap()
    };
    assert_eq!(bed("staircase", "f16"), []);
    assert_eq!(bed("exact", "f32"), []);
    let found = bed("exact", "f16");
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].place, "solids[0].surface");
}

#[test]
fn a_run_of_many_steps_is_warned_of() {
    let scene = read(STONE).unwrap();
    let warned = |time_step: f64| {
        let advice = scene.suspicious_keys(time_step);
        advice.iter().any(|one| one.message.contains("steps of"))
    };
    assert!(warned(1e-9) && !warned(1e-8));
}

/// A sphere of radius R under water, (ρ − 1000) 4/3 π R³ g = k π u² (2R − u) at rest; u = 1.3 % of R at 1.63e7 Pa/m.
#[test]
fn blocks_that_sink_into_a_plane_at_rest_are_told() {
    let size = "kind = \"box\"\nsize = [0.05, 0.05, 0.05]";
    let sphere = "kind = \"sphere\"\nradius = 0.025";
    let with = |shape: &str, stiffness: f64| {
        let text = STONE.replace(size, shape);
        let text = text.replace(
            "normal_stiffness = 1e9",
            &format!("normal_stiffness = {stiffness}"),
        );
        let scene = read(&text).unwrap();
        let found = scene.suspicious_keys(1e-3);
        found.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    let (radius, gravity) = (0.025f64, 9.81);
    let stiffness = |depth: f64| {
        let u = depth * radius;
        1650.0 * 4.0 / 3.0 * radius.powi(3) * gravity / (u * u * (2.0 * radius - u))
    };
    let found = with(sphere, stiffness(0.013));
    assert_eq!(found.len(), 1, "{found:?}");
    let remedy = format!("use normal_stiffness ≥ {:.2e} Pa/m", stiffness(0.01));
    for words in [
        "materials.r.normal_stiffness",
        "by 1.3 % of its radius",
        &remedy,
    ] {
        assert!(found[0].contains(words), "`{words}`: {found:?}");
    }
    assert_eq!(with(sphere, stiffness(0.0099)), [""; 0]);
    // A box by its weight over k A.
    let of_box = |depth: f64| 1650.0 * 0.05 * gravity / (depth * 0.025);
    let found = with(size, of_box(0.02));
    assert!(found.len() == 1 && found[0].contains("by 2.0 % of half its least edge"));
    assert_eq!(with(size, of_box(0.0099)), [""; 0]);
}
