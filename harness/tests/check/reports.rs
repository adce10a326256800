//! Output of `check`, `adapters` and `schema`.

use kit::scene::STILL_WATER;
use serde_json::Value;
use std::process::Command;

fn json(arguments: &[&str]) -> Value {
    let output = Command::new(env!("CARGO_BIN_EXE_riprap"))
        .args(arguments)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {said}");
    serde_json::from_slice(&output.stdout).unwrap()
}

fn scene(name: &str) -> String {
    format!("{}/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"))
}

/// 64 × 64 × 4 periodic cells without forces: one kernel, without unused features.
#[test]
fn a_periodic_scene_runs_one_kernel() {
    let report = json(&["check", &scene("taylor_green"), "--json"]);
    let cells = &report["cells"];
    assert_eq!(cells["fluid"], 16384);
    assert_eq!((&cells["solid"], &cells["links"]), (&0.into(), &0.into()));
    assert_eq!(report["memory"]["kinds"]["populations"], 16384 * 27 * 4);
    let kernels = report["kernels"].as_array().unwrap();
    assert_eq!(kernels.len(), 1);
    assert_eq!(kernels[0]["file"], "collide_stream");
    let slots = &kernels[0]["slots"];
    let absent = [
        ("eddy", "eddy_none"),
        ("force", "force_none"),
        ("cell_flags", "cell_flags_none"),
    ];
    for (slot, file) in absent {
        assert_eq!(slots[slot], file);
    }
    // Ma = 0.05 at the largest speed: Δt = 0.05 Δx/(√3 U) = 4.52 ms, τ = ½ + 3 ν Δt/Δx².
    let numerics = &report["numerics"];
    let number = |key: &str| numerics[key].as_f64().unwrap();
    assert!((number("mach") - 0.05).abs() < 1e-12);
    assert!((number("time_step") - 4.5214e-3).abs() < 1e-7);
    assert!((number("tau") - 0.555559).abs() < 1e-6);
    assert_eq!(numerics["steps"], 1942);
    assert!(report["time"]["run"].as_f64().unwrap() > 0.0);
}

#[test]
fn a_scene_with_everything_names_its_kernels_and_solids() {
    let report = json(&["check", &scene("offset_joint"), "--json"]);
    let cells = &report["cells"];
    // Below y = 0.0508 m 80 × 32, and from 0.1397 m on 112 × 40 cells of 200 × 96 are rock.
    assert_eq!(cells["solid"], 4 * (80 * 32 + 112 * 40));
    let bricks = ["plain_bricks", "mixed_bricks", "idle_bricks"];
    assert!(
        bricks.iter().all(|kind| cells[kind].as_u64() > Some(0)),
        "{cells}"
    );
    let free = json(&["check", &scene("couette"), "--json"]);
    assert_eq!(free["cells"]["idle_bricks"], 0, "padding is no rock");
    let kernels = report["kernels"].as_array().unwrap();
    let entries: Vec<_> = kernels
        .iter()
        .map(|k| k["entry"].as_str().unwrap())
        .collect();
    for entry in ["reflect", "move_wall", "apply_outflow", "collide_stream"] {
        assert!(entries.contains(&entry), "{entries:?}");
    }
    let wale = |kernel: &Value| kernel["slots"]["eddy"] == "eddy_wale";
    assert_eq!(kernels.iter().filter(|k| wale(k)).count(), 2);
}

#[test]
fn the_report_for_people_has_the_same_facts() {
    let output = Command::new(env!("CARGO_BIN_EXE_riprap"))
        .args(["check", &scene("couette")])
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    for fact in [
        "8 × 32 × 8: 2048 fluid, 0 solid",
        "16628 steps of 9.0211e-3 s",
        "Mach 0.100",
        "0.1875 everywhere, no floor",
        "moving_wall (move_wall)",
    ] {
        assert!(text.contains(fact), "{fact} is not in:\n{text}");
    }
}

/// In this scheme the speed of sound is √5 times the largest speed.
#[test]
fn the_published_scheme_of_particles_has_its_own_sound() {
    let text = STILL_WATER.replace("plane = true", "plane = true\nscheme = \"mueller\"");
    let file = format!("{}/check_mueller.toml", env!("CARGO_TARGET_TMPDIR"));
    std::fs::write(&file, text).unwrap();
    let report = json(&["check", &file, "--json"]);
    let number = |key: &str| report[key].as_f64().unwrap();
    let largest = (2.0 * 9.81 * 0.8f64).sqrt();
    assert!((number("largest_speed") / largest - 1.0).abs() < 1e-9);
    assert!((number("sound_speed") / (5.0f64.sqrt() * largest) - 1.0).abs() < 1e-9);
    assert!((number("mach") * 5.0f64.sqrt() - 1.0).abs() < 1e-9);
}

#[test]
fn adapters_are_listed_with_the_default_first() {
    let all = json(&["adapters", "--json"]);
    let all = all.as_array().unwrap();
    let default: Vec<_> = all
        .iter()
        .map(|a| a["default"].as_bool().unwrap())
        .collect();
    assert!(default[0] && !default[1..].contains(&true));
    for adapter in all {
        assert!(
            adapter["limits"]["storage_buffers"].as_u64() >= Some(8),
            "{adapter}"
        );
    }
}

/// The schema knows every key of the shipped scenes' tables, and that others are refused.
#[test]
fn the_schema_is_that_of_scenes() {
    let schema = json(&["schema"]);
    assert_eq!(schema["additionalProperties"], false);
    let properties = &schema["properties"];
    for key in [
        "domain",
        "fluid",
        "numerics",
        "boundaries",
        "solids",
        "run",
        "probes",
    ] {
        assert!(properties[key].is_object(), "{key}");
    }
}

/// A cube with 12 cells along an edge: the error of its drag is that of the report on bodies of its size.
#[test]
fn the_error_of_the_drag_is_that_of_the_report() {
    let report = json(&["check", &scene("incline_flow"), "--json"]);
    let accuracy = &report["accuracy"][0];
    assert_eq!(accuracy["of"], "drag on blocks");
    let number = |key: &str| accuracy[key].as_f64().unwrap();
    assert!((number("across") - 12.0).abs() < 1e-9);
    assert_eq!(number("tau"), report["numerics"]["tau"].as_f64().unwrap());
    let [low, high] = [0, 1].map(|n| accuracy["band"][n].as_f64().unwrap());
    assert!(0.0 < low && low <= high && high < 0.5, "{accuracy}");
}

/// By the cubic law, from the conductances of one and of two rows of cells at low viscosity: 0.692 and 2.82 in lattice units.
#[test]
fn the_apertures_of_closed_joints_are_in_metres() {
    let report = json(&["check", &scene("incline_flow"), "--json"]);
    let joints = &report["blocks"]["closed_joints"];
    let pair = |key: &str| [0, 1].map(|n| joints[key][n].as_f64().unwrap());
    let step = report["numerics"]["time_step"].as_f64().unwrap();
    let (cell, viscosity) = (0.2 / 12.0, 1e-6);
    for (found, conductance) in pair("apertures").iter().zip([0.4286, 2.817]) {
        let expected = (12.0 * viscosity * conductance * cell * step).cbrt();
        assert!((found / expected - 1.0).abs() < 2e-3, "{found} {expected}");
    }
    // The half times follow from D = C/7 in two rows and C/4 in a shared one, for squares of 12 cells.
    let expected = [7.0 / 2.817, 4.0 / 0.4286].map(|slow| 0.0594 * 144.0 * slow * step);
    for (found, expected) in pair("times").iter().zip(expected) {
        assert!((found / expected - 1.0).abs() < 2e-3, "{found} {expected}");
    }
}

/// Each program is written once, complete, with the files of its slots.
#[test]
fn the_kernels_of_a_scene_are_written() {
    for (name, some) in [
        (
            "settling_sphere",
            &["collide_stream_1", "voxelise", "initialise"][..],
        ),
        ("dam_break", &["accelerate", "sort_count"]),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let to = folder.path().to_str().unwrap();
        json(&["check", &scene(name), "--json", "--kernels", to]);
        for file in some {
            let text = std::fs::read_to_string(folder.path().join(format!("{file}.wgsl"))).unwrap();
            let kernel = file.trim_end_matches("_1");
            assert!(text.contains(&format!("fn {kernel}(")), "{file}");
            assert!(!text.contains("// unroll"), "{file}");
        }
    }
}
