//! `riprap run --error-estimate`: its comparisons and refusals.

use crate::fixture::{args, column, folder, go, json, last};
use kit::{assert_contains, assert_near, scene::STILL_WATER};
use riprap_harness::run::{Args, Estimate, Headline, run};
use std::{path::Path, sync::atomic::AtomicBool};

/// A channel driven by a force, with cells of 1/8 m: a parabolic profile after some time.
const CHANNEL: &str = r#"
    [domain]
    size = [1, 1, 1]
    cell = 0.125
    [fluid]
    viscosity = 0.1
    acceleration = [0.08, 0, 0]
    [numerics]
    mach = 0.1
    velocity_scale = 0.1
    [boundaries]
    y_min = { kind = "wall" }
    y_max = { kind = "wall" }
    [run]
    duration = 2
    [[output.histories]]
    quantities = ["mass", "momentum_x"]
    every = 0.1
    [[probes]]
    name = "middle"
    kind = "point"
    at = [0.5, 0.5, 0.5]
    fields = ["velocity"]
    every = 0.1
    [[probes]]
    name = "profile"
    kind = "line"
    from = [0.5, 0, 0.5]
    to = [0.5, 1, 0.5]
    count = 5
"#;

/// A tank of water, 24 × 16 particles.
fn water() -> String {
    let fine = STILL_WATER.replace("spacing = 0.1", "spacing = 0.05");
    let short = fine.replace("steps = 12", "steps = 8");
    format!("{short}[[output.histories]]\nquantities = [\"mass\", \"potential_energy\"]\n")
}

fn estimated(folder: &Path, text: &str) -> Estimate {
    let args = Args {
        error_estimate: true,
        ..args(folder, text, "out")
    };
    let summary = go(&args);
    assert!(summary.complete);
    summary.error_estimate.unwrap()
}

fn find<'a>(estimate: &'a Estimate, table: &str, quantity: &str) -> &'a Headline {
    let mut all = estimate.headlines.iter();
    let found = all.find(|h| h.table == table && h.quantity == quantity);
    found.unwrap_or_else(|| panic!("no {quantity} of {table} in {estimate}"))
}

fn refused(folder: &Path, text: &str) -> String {
    let args = Args {
        error_estimate: true,
        ..args(folder, text, "out")
    };
    let error = run(&args, &AtomicBool::new(false)).unwrap_err();
    format!("{error:#}")
}

/// The coarse numbers equal those of a separate run of the scene with cells twice as wide.
#[test]
fn a_flow_is_compared_with_cells_twice_as_wide() {
    let folder = folder("estimate_channel");
    let estimate = estimated(&folder, CHANNEL);
    assert_eq!(estimate.missing, None);
    assert_eq!(estimate.resolution, "cells of 0.25 m");

    let wide = CHANNEL.replace("cell = 0.125", "cell = 0.25");
    go(&args(&folder, &wide, "wide"));
    let mean = |path: &str| {
        let [times, values] = ["time", "velocity_x"].map(|name| column(&folder.join(path), name));
        let rows = times.into_iter().zip(values);
        let last: Vec<f64> = rows.filter(|(t, _)| *t >= 1.5).map(|(_, u)| u).collect();
        last.iter().sum::<f64>() / last.len() as f64
    };
    let velocity = find(&estimate, "middle", "velocity");
    assert_eq!(velocity.value[0], mean("out/middle.csv"));
    assert_eq!(velocity.coarse[0], mean("wide/middle.csv"));
    // The slip of the wall on four cells is a few percent of u.
    let relative = velocity.relative.unwrap();
    assert!((1e-3..0.3).contains(&relative), "{estimate}");
    assert_eq!(velocity.unit, "m/s");

    assert!(find(&estimate, "history", "mass").relative.unwrap() < 1e-6);
    assert!(find(&estimate, "history", "momentum_x").value[0] > 0.0);
    assert!(estimate.headlines.iter().all(|h| h.table != "profile"));

    let told = estimate.to_string();
    assert_contains(told, &["middle: velocity (", " m/s ± "]);
    let json = json(&folder.join("out/summary.json"));
    let all = json["error_estimate"]["headlines"].as_array().unwrap();
    assert_eq!(all.len(), estimate.headlines.len());
}

#[test]
fn an_odd_number_of_cells_is_refused_with_what_would_do() {
    let text = CHANNEL.replace("size = [1, 1, 1]", "size = [1, 1.125, 1]");
    let error = refused(&folder("estimate_odd"), &text);
    let parts = [
        "9 cells",
        "along y",
        "1.000000 or 1.250000 m",
        "--error-estimate",
    ];
    assert_contains(error, &parts);
}

#[test]
fn a_scene_without_measurements_says_so() {
    let cut = CHANNEL.find("[[output.histories]]").unwrap();
    let text = CHANNEL[..cut].replace("duration = 2", "duration = 0.1");
    let estimate = estimated(&folder("estimate_nothing"), &text);
    assert!(estimate.missing.unwrap().contains("[[probes]]"));
}

/// s = ½gt²(sin 30° − cos 30° tan 25°), exact at any step except those of the contact.
#[test]
fn dry_blocks_are_compared_with_steps_twice_as_long() {
    let text = include_str!("../../scenes/incline.toml");
    let cut = text.find("[[views]]").unwrap();
    let estimate = estimated(&folder("estimate_dry"), &text[..cut]);
    assert_eq!(estimate.missing, None);
    let position = find(&estimate, "smooth", "position");
    assert!(position.difference < 1e-3, "{estimate}");
    assert!(position.difference > 0.0, "{estimate}");
}

/// Bonds shorten the usual step, once they are known.
#[test]
fn bonded_blocks_are_compared_with_steps_twice_as_long() {
    let text = "[[materials]]\nname = \"rock\"\ndensity = 2500\nnormal_stiffness = 1e9\nfriction = 30\ncohesion = 1e6\n\
                tensile_strength = 1e6\n[[solids]]\nkind = \"box\"\nmin = [-3, -3, -1]\nmax = [3, 3, 0]\n\
                [[blocks]]\nname = \"stone\"\nkind = \"box\"\nsize = [1, 1, 0.5]\nposition = [0, 0, 0.25]\n\
                repeat = { count = 3, step = [0, 0, 0.5] }\n[run]\nduration = 0.01\n\
                [[probes]]\nname = \"stone\"\nkind = \"block\"\nblock = \"stone_1\"\nevery = 1e-3\n";
    let estimate = estimated(&folder("estimate_bonds"), text);
    assert_eq!(estimate.missing, None);
}

#[test]
fn water_is_compared_with_particles_twice_as_far_apart() {
    let estimate = estimated(&folder("estimate_water"), &water());
    assert_eq!(estimate.resolution, "particles 0.1 m apart");
    assert!(find(&estimate, "history", "mass").relative.unwrap() < 1e-6);
}

/// The steps of a scene divide its output intervals; at half the resolution there are fewer of them.
#[test]
fn both_runs_of_water_end_together() {
    let folder = folder("estimate_end");
    let text = water().replace(
        "\"potential_energy\"]",
        "\"potential_energy\"]\n        every = 0.05",
    );
    let estimate = estimated(&folder, &text);
    let end = |folder: &Path| last(&folder.join("history.csv"), "time");
    let ends = [&folder.join("out"), &estimate.folder].map(|folder| end(folder));
    // Three steps per interval.
    assert_near(ends[0], 8.0 * 0.05 / 3.0, 1e-9);
    assert_near(ends[0], ends[1], 1e-9);
}

#[test]
fn a_restart_is_refused() {
    let folder = folder("estimate_restart");
    let args = Args {
        error_estimate: true,
        restart: Some("state.riprap".into()),
        ..args(&folder, CHANNEL, "out")
    };
    let error = run(&args, &AtomicBool::new(false)).unwrap_err();
    assert!(error.to_string().contains("--restart"), "{error}");
}
