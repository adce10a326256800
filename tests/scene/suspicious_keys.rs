//! What computes, but is probably not what was meant: a warning names it, and its neighbour on the right side is silent.

use crate::read;

/// A block in a fluid that weighs along z, as the block does.
const RIGHT: &str = r#"
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

/// The warnings of the right scene with `from` replaced by `to`, in steps of 1 ms.
fn suspicious(from: &str, to: &str) -> Vec<String> {
    assert!(RIGHT.contains(from), "{from}");
    let scene = read(&RIGHT.replace(from, to)).unwrap();
    scene
        .suspicious_keys(1e-3)
        .iter()
        .map(ToString::to_string)
        .collect()
}

#[track_caller]
fn told(from: &str, to: &str, words: &[&str]) {
    let found = suspicious(from, to);
    assert_eq!(found.len(), 1, "{found:?}");
    for word in words {
        assert!(found[0].contains(word), "`{word}` is not in: {}", found[0]);
    }
}

#[track_caller]
fn silent(from: &str, to: &str) {
    assert_eq!(suspicious(from, to), [""; 0]);
}

#[test]
fn fluid_and_blocks_that_fall_along_different_ways() {
    silent("hold", "hold");
    let fluid = "acceleration = [0, 0, -9.81]";
    told(
        fluid,
        "acceleration = [0, -9.81, 0]",
        &["rock.gravity", "fluid.acceleration", "-9.81"],
    );
    told(fluid, "acceleration = [0, 0, 9.81]", &["rock.gravity"]);
    // Less than gravity, none, or a formula: it drives a flow.
    silent(fluid, "acceleration = [1, 0, 0]");
    silent(fluid, "acceleration = [0, 0, 0]");
    silent("gravity = [0, 0, -9.81]", "gravity = [0, 0, 0]");
    silent("gravity = [0, 0, -9.81]", "gravity = [0, 0, -9.8]");
}

#[test]
fn blocks_that_are_held_to_the_end() {
    told("hold = 0", "hold = 99", &["coupling.hold", "99 s", "0.2"]);
    told("hold = 0", "hold = 0.2", &["coupling.hold"]);
    silent("hold = 0", "hold = 0.19");
    told(
        "hold = 0",
        "interval = 100000",
        &["coupling.interval", "0.2"],
    );
    silent("hold = 0", "interval = 2");
}

#[test]
fn a_probe_that_is_faster_than_the_run() {
    let every = "every = 0.002";
    told(every, "every = 1e-9", &["probes.p.every", "1.0000e-3"]);
    told(every, "every = 9e-4", &["probes.p.every"]);
    silent(every, "every = 1e-3");
    silent(every, "every = 0.9999e-3");
}

#[test]
fn friction_that_is_a_tangent() {
    // tan 31° = 0.6009.
    told(
        "friction = 30",
        "friction = 0.6009",
        &["materials.r.friction", "degrees", "friction = 31.0"],
    );
    silent("friction = 30", "friction = 0");
    silent("friction = 30", "friction = 1.5");
    let pair = "[[material_pairs]]\nbetween = [\"r\", \"r\"]\nfriction = 0.7\n[run]";
    told("[run]", pair, &["material_pairs[0].friction", "35.0"]);
}

#[test]
fn a_driven_block_without_a_drive() {
    let driven = "size = [0.05, 0.05, 0.05]\nmotion = \"driven\"";
    told(
        "size = [0.05, 0.05, 0.05]",
        driven,
        &["blocks[0].motion", "stands still", "fixed"],
    );
    for drive in ["velocity = [0.01, 0, 0]", "spin = [0, \"sin(t)\", 0]"] {
        silent("size = [0.05, 0.05, 0.05]", &format!("{driven}\n{drive}"));
    }
}

/// A sphere of radius R under water, (ρ − 1000) 4/3 π R³ g = k π u² (2R − u) at rest; u = 1.3 % of R at 1.63e7 Pa/m.
#[test]
fn blocks_that_sink_into_a_plane_at_rest_are_told() {
    let size = "kind = \"box\"\nsize = [0.05, 0.05, 0.05]";
    let sphere = "kind = \"sphere\"\nradius = 0.025";
    let with = |shape: &str, stiffness: f64| {
        let text = RIGHT.replace(size, shape);
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
