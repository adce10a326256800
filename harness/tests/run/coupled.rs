//! `riprap run` and `riprap check` on small scenes of blocks in a fluid.

use crate::fixture::{
    args, assert_refused, assert_same_files, check, column, folder, go, json, last, read_with_vtk,
    restarted, riprap, said,
};
use kit::{assert_contains, assert_near, assert_relative};
use riprap_harness::run::Args;
use serde_json::Value;
use std::fs;

/// A stone on the bed of a short channel, and a sinking ball that the flow carries along.
const CHANNEL: &str = r#"
title = "channel"
[domain]
size = [0.16, 0.08, 0.08]
cell = 0.005
[fluid]
viscosity = 1e-4
[numerics]
velocity_scale = 0.4
[boundaries]
x_min = { kind = "velocity", velocity = [0.2, 0, 0] }
x_max = { kind = "pressure" }
z_min = { kind = "wall" }
z_max = { kind = "free_slip" }
[initial]
velocity = [0.2, 0, 0]
[[materials]]
name = "rock"
density = 2650
normal_stiffness = 1e7
friction = 35
[[blocks]]
name = "stone"
kind = "box"
size = [0.04, 0.04, 0.02]
position = [0.06, 0.04, 0.01]
[[blocks]]
name = "ball"
kind = "sphere"
radius = 0.01
position = [0.11, 0.04, 0.05]
[run]
steps = 40
[output]
every = 0.02
[[output.slices]]
name = "middle"
axis = "y"
field = "speed"
[[output.histories]]
quantities = ["kinetic_energy", "mass", "block_kinetic_energy", "energy_error", "contacts", "awake_blocks"]
every = 0.005
[[probes]]
name = "stone"
kind = "block"
block = "stone"
every = 0.005
[[probes]]
name = "wake"
kind = "point"
at = [0.1, 0.04, 0.01]
every = 0.01
[[views]]
name = "view"
size = [320, 240]
slices = [{ axis = "y", field = "speed" }]
"#;

/// A cube held in water at rest between walls, 8 cells across.
const HELD: &str = r#"
title = "held"
[domain]
size = [0.16, 0.16, 0.16]
cell = 0.01
[fluid]
viscosity = 1e-3
[numerics]
velocity_scale = 0.1
[boundaries]
x_min = { kind = "wall" }
x_max = { kind = "wall" }
y_min = { kind = "wall" }
y_max = { kind = "wall" }
z_min = { kind = "wall" }
z_max = { kind = "wall" }
[[materials]]
name = "rock"
density = 2650
normal_stiffness = 1e7
friction = 35
[[blocks]]
name = "cube"
kind = "box"
size = [0.08, 0.08, 0.08]
position = [0.08, 0.08, 0.083]
motion = "fixed"
[run]
steps = 12
[[probes]]
name = "cube"
kind = "block"
block = "cube"
"#;

#[test]
fn a_coupled_run_writes_what_both_write() {
    let folder = folder("coupled_files");
    let summary = go(&args(&folder, CHANNEL, "out"));
    let out = folder.join("out");
    assert!(summary.complete && !summary.diverged, "{summary}");
    assert!(summary.files.iter().all(|path| path.is_file()));
    for name in [
        "fields.pvd",
        "blocks.pvd",
        "contacts.pvd",
        "history.csv",
        "history.png",
        "stone.csv",
        "wake.csv",
        "middle_000040.png",
        "view_000040.png",
        "view.png",
        "stone.png",
        "checkpoint.riprap",
    ] {
        assert!(summary.files.contains(&out.join(name)), "{name}");
    }
    // The flow pushes the stone; buoyancy with ρ g = 9810 N/m³ carries 0.314 N of it.
    let stone = out.join("stone.csv");
    assert!(column(&stone, "fluid_force_x")[1] > 0.0);
    let buoyancy = last(&stone, "buoyancy_z");
    assert_relative(buoyancy, 0.31392, 0.01);
    // Contacts carry the weight of 0.832 N less buoyancy on average: the stone was set down at once.
    let held: Vec<f64> = column(&stone, "force_z");
    assert!(held.iter().any(|force| *force > 0.2), "{held:?}");
    let history = out.join("history.csv");
    for quantity in ["kinetic_energy", "mass", "block_kinetic_energy"] {
        assert!(last(&history, quantity) > 0.0, "{quantity}");
    }
    assert!(last(&history, "energy_error").abs() < 0.02);
    assert_eq!(last(&history, "awake_blocks"), 2.0);

    let blocks = read_with_vtk(&out.join("blocks.pvd"));
    // Walls are blocks too, but are not drawn.
    assert_eq!(blocks["cells"].as_array().unwrap().len(), 2);
    let arrays = &blocks["arrays"];
    let force = arrays["fluid_force"][0][0].as_f64().unwrap();
    assert_relative(force, last(&stone, "fluid_force_x"), 1e-5);
    // The ball's volume times ρ g.
    let ball = arrays["buoyancy"][1][2].as_f64().unwrap();
    assert_relative(ball, 0.041_09, 0.02);
    assert!(arrays["velocity"][1][2].as_f64().unwrap() < 0.0);

    let json = json(&out.join("summary.json"));
    for key in ["mlups", "cells", "tau", "y_plus_walls", "y_plus_blocks"] {
        assert!(json[key].is_number() || json[key].is_array(), "{key}");
    }
    assert_eq!(json["rocks"]["blocks"], 2);
    let coupling = &json["coupling"];
    assert_eq!(coupling["in_fluid"], 2);
    assert_eq!(coupling["readings"], 40);
    assert_eq!(coupling["readings_skipped"], 0);
    assert!(coupling["saturated_bricks"].as_u64().unwrap() > 0);
    assert_contains(summary, &["MLUPS", "y⁺", "2 blocks in the fluid", "awake"]);
}

#[test]
fn a_coupled_restart_goes_on_to_the_same_bits() {
    let folder = folder("coupled_restart");
    // A point in a cell that the ball cuts, whose fluid velocity includes the effect of the ball in the last step.
    let text = CHANNEL.replace("every = 0.02", "every = 0.01");
    let text = text.replace("[0.1, 0.04, 0.01]", "[0.119, 0.04, 0.05]");
    let text = &text[..text.find("[[views]]").unwrap()];
    // At the step of the cut, fields and probes are due.
    let files = [
        "checkpoint.riprap",
        "blocks_000040.vtu",
        "fields_000028.vti",
        "fields_000040.vti",
        "stone.csv",
        "wake.csv",
        "history.csv",
        "blocks.pvd",
    ];
    restarted(&folder, text, 28, &files);
    // In a folder without the files of the first part.
    let mut elsewhere = args(&folder, text, "elsewhere");
    elsewhere.restart = Some(folder.join("cut.riprap"));
    assert!(go(&elsewhere).complete);
    let files = [
        "fields_000028.vti",
        "fields_000040.vti",
        "blocks_000028.vtu",
    ];
    assert_same_files(&folder, ["whole", "elsewhere"], &files);
    for name in ["stone.csv", "wake.csv"] {
        let [one, two] = ["whole", "elsewhere"]
            .map(|out| fs::read_to_string(folder.join(out).join(name)).unwrap());
        let (_, rows) = two.split_once('\n').unwrap();
        assert!(
            rows.lines().count() > 1 && one.ends_with(rows),
            "{name} differs elsewhere"
        );
    }
    let energy = last(&folder.join("whole/history.csv"), "block_kinetic_energy");
    assert!(energy > 1e-5, "nothing moves: {energy} J");
}

#[test]
fn a_held_block_tells_its_buoyancy_and_feels_no_flow_where_there_is_none() {
    let folder = folder("coupled_held");
    assert!(go(&args(&folder, HELD, "out")).complete);
    let cube = folder.join("out/cube.csv");
    // ρ g V = 1000 · 9.81 · 0.08³ N.
    let buoyancy = last(&cube, "buoyancy_z");
    assert_relative(buoyancy, 5.022_72, 1e-4);
    for axis in ["x", "y", "z"] {
        for what in ["fluid_force", "fluid_torque"] {
            let flow = last(&cube, &format!("{what}_{axis}"));
            assert!(flow.abs() < 1e-6 * buoyancy, "{what}_{axis} = {flow}");
        }
    }
}

/// On the floor of the tank the base is dry and the only face in a joint. The only load is buoyancy; the weight is 2.65
/// times as much, also in moments about each edge of the base.
#[test]
fn a_block_tells_its_faces_and_how_safely_it_stands() {
    let folder = folder("coupled_faces");
    let text = HELD.replace("0.083]", "0.04]").replace(
        "block = \"cube\"\n",
        "block = \"cube\"\nfaces = true\nsafety = true\n",
    );
    let summary = go(&args(&folder, &text, "out"));
    let told = summary.to_string();
    let line = "cube: factor of safety sliding inf, uplift 2.65, toppling 2.65 at";
    assert!(told.contains(line), "{told}");
    let cube = folder.join("out/cube.csv");
    assert_eq!(last(&cube, "safety_sliding"), f64::INFINITY);
    assert_relative(last(&cube, "safety_uplift"), 2.65, 1e-4);
    // The water is weightless and at rest, also at the rim of the joint.
    assert!(last(&cube, "joint_pressure").abs() < 1e-3);
    let faces = folder.join("out/cube_faces.csv");
    let [normal, area, wetted, pressure, joint, closed, inside] = [
        "normal_z",
        "area",
        "wetted_area",
        "pressure",
        "joint",
        "joint_area",
        "joint_pressure",
    ]
    .map(|name| column(&faces, name));
    assert_eq!(normal.len(), 6);
    for face in 0..6 {
        let base = normal[face] < -0.5;
        assert_relative(area[face], 0.0064, 1e-12);
        assert_eq!(wetted[face], if base { 0.0 } else { area[face] });
        assert_eq!(joint[face], f64::from(u8::from(base)));
        assert!(pressure[face].is_nan() == base && (base || pressure[face].abs() < 1e-3));
        assert_near(closed[face], if base { area[face] } else { 0.0 }, 1e-12);
        assert!(inside[face].is_nan() != base && (!base || inside[face].abs() < 1e-3));
    }
    let shown = read_with_vtk(&folder.join("out/faces.pvd"));
    assert_eq!(shown["points"].as_array().unwrap().len(), 24);
    for name in ["block", "pressure", "wetted", "shear"] {
        let values = shown["arrays"][name].as_array().unwrap();
        assert_eq!(values.len(), 6, "{name}");
    }
}

/// Loads on a block that never moves are read back on request, and do not depend on earlier requests.
#[test]
fn the_drag_of_a_held_block_is_that_of_the_last_steps() {
    let folder = folder("coupled_drag");
    let text = HELD
        .replace(
            "x_min = { kind = \"wall\" }\nx_max = { kind = \"wall\" }",
            "x_min = { kind = \"velocity\", velocity = [0.1, 0, 0] }\nx_max = { kind = \"pressure\" }",
        )
        .replace("[[blocks]]", "[initial]\nvelocity = [0.1, 0, 0]\n[[blocks]]");
    go(&args(&folder, &text, "seldom"));
    let often = text.replace(
        "block = \"cube\"\n",
        "block = \"cube\"\nevery = 1e-6\n[[probes]]\nname = \"other\"\nkind = \"point\"\nat = [0.01, 0.01, 0.01]\nevery = 0.02\n",
    );
    go(&args(&folder, &often, "often"));
    let [seldom, often] = ["seldom", "often"].map(|out| folder.join(out).join("cube.csv"));
    assert!(last(&seldom, "fluid_force_x") > 0.0);
    for name in ["fluid_force_x", "fluid_torque_y", "buoyancy_z"] {
        assert_eq!(last(&seldom, name), last(&often, name), "{name}");
    }
    assert_eq!(column(&often, "time").len(), 13);
}

/// A cube that a ram pushes through water against another one, which stands in front of a wall.
#[test]
fn a_crushed_block_names_the_last_checkpoint_and_loses_nothing() {
    let folder = folder("coupled_crush");
    let text = HELD.replace("motion = \"fixed\"", "").replace(
        "[[blocks]]\nname = \"cube\"",
        "[rock]\ngravity = [0, 0, 0]\n[[blocks]]\nname = \"ram\"\nkind = \"box\"\n\
         size = [0.02, 0.08, 0.08]\nposition = [0.02, 0.08, 0.08]\nmotion = \"driven\"\n\
         velocity = [0.5, 0, 0]\n[[blocks]]\nname = \"cube\"",
    );
    let text = text
        .replace("steps = 12", "steps = 400")
        .replace("velocity_scale = 0.1", "velocity_scale = 1")
        .replace("block = \"cube\"\n", "block = \"cube\"\nevery = 0.01\n")
        .replace("normal_stiffness = 1e7", "normal_stiffness = 1e6");
    let args = args(&folder, &text, "out");
    let summary = go(&args);
    assert!(summary.diverged && !summary.complete, "{summary}");
    let told = summary.divergence.as_deref().unwrap();
    assert_contains(told, &["cube", "overlap by"]);
    let checkpoint = summary.checkpoint.clone().unwrap();
    let step = summary.checkpoint_step.unwrap();
    assert!(step > 0 && step < summary.steps && checkpoint.is_file());
    let told = summary.to_string();
    assert!(told.contains(&format!("--restart {}", checkpoint.display())));
    assert!(column(&folder.join("out/cube.csv"), "time").len() > 2);
    let program = riprap(&folder, &["run", "--json", "--out", "again", "scene.toml"]);
    assert_eq!(program.status.code(), Some(1));
    assert_contains(
        said(&program),
        &["overlap by", "--restart", &format!("step {step}")],
    );
    // The run continues from the state.
    let rest = Args {
        restart: Some(checkpoint),
        steps: Some(step + 2),
        ..args
    };
    assert!(go(&rest).complete);
}

#[test]
fn shear_that_is_not_resolved_is_told_with_numbers() {
    let folder = folder("coupled_shear");
    let fast = CHANNEL
        .replace("0.2, 0, 0]", "2, 0, 0]")
        .replace(
            "velocity_scale = 0.4",
            "velocity_scale = 4\neddy_viscosity = \"wale\"",
        )
        .replace("viscosity = 1e-4", "viscosity = 1e-5");
    let fast = fast.replace("steps = 40", "steps = 20");
    let text = &fast[..fast.find("[output]").unwrap()];
    let summary = go(&args(&folder, text, "out"));
    // ½ Δx U/ν = 500 at the inlet's speed: y⁺ is near √500.
    let y_plus = summary.y_plus_blocks.unwrap();
    assert!((5.0..45.0).contains(&y_plus), "{y_plus}");
    assert!(summary.y_plus_walls.unwrap() > 5.0);
    for block in ["beside a wall", "beside block"] {
        let told = summary.warnings.iter().find(|told| told.contains(block));
        let told = told.unwrap();
        assert_contains(told, &["y⁺", "no wall model", "Cells of"]);
    }
}

#[test]
fn check_says_what_blocks_in_a_fluid_will_run() {
    // A second stone at a distance of 1 mm, a fifth of a cell, from the first.
    let text = CHANNEL.replace(
        "[[blocks]]\nname = \"ball\"",
        "[[blocks]]\nname = \"brick\"\nkind = \"box\"\nsize = [0.02, 0.04, 0.02]\n\
         position = [0.091, 0.04, 0.01]\n[[blocks]]\nname = \"ball\"",
    );
    let (json, told) = check(&folder("coupled_check"), &text);
    let kernels = json["kernels"].as_array().unwrap();
    let named = |entry: &str| kernels.iter().find(|kernel| kernel["entry"] == entry);
    for entry in ["voxelise", "combine_parts", "reduce_tiles", "reduce_blocks"] {
        assert!(named(entry).is_some(), "{entry}");
    }
    let holdych = |kernel: &&Value| kernel["slots"]["operator"] == "operator_holdych";
    assert_eq!(kernels.iter().filter(holdych).count(), 1);
    assert!(json["memory"]["kinds"]["blocks"].as_u64().unwrap() > 0);
    let blocks = &json["blocks"];
    assert_eq!((&blocks["blocks"], &blocks["free"]), (&3.into(), &3.into()));
    assert_eq!(blocks["cells"]["in_fluid"], 3);
    assert!(blocks["cells"]["tiles"].as_u64().unwrap() > 0);
    assert!(blocks["sub_steps"].as_u64().unwrap() >= 1);
    // Both stones touch the bed, and have a gap between them.
    assert_eq!(blocks["closed_gaps"], 2);
    let gap = &blocks["narrowest"][0];
    assert_eq!(gap["blocks"], serde_json::json!(["stone", "brick"]));
    assert_near(gap["cells"].as_f64().unwrap(), 0.2, 1e-9);
    let warnings = json["warnings"].to_string();
    assert_contains(
        &warnings,
        &[
            "3 blocks are fewer than 8 cells across",
            "gaps between blocks narrower than a cell: 1",
            "between stone and brick",
        ],
    );
    assert!(!warnings.contains("lighter"), "{warnings}");
    let words = [
        "in the fluid",
        "sub-steps",
        "stone and brick",
        "0.20 cells",
        "warning",
    ];
    assert_contains(told, &words);
}

#[test]
fn blocks_lighter_than_the_fluid_are_told() {
    let (json, _) = check(&folder("coupled_light"), &CHANNEL.replace("2650", "600"));
    let words = ["2 blocks are lighter than the fluid", "0.60"];
    assert_contains(&json["warnings"], &words);
}

#[test]
fn what_cannot_be_is_refused_with_what_to_change() {
    let ball = "position = [0.11, 0.04, 0.05]";
    let stone = "position = [0.06, 0.04, 0.01]";
    for (name, from, to, words) in [
        (
            "outside",
            ball,
            "position = [0.11, 0.04, 0.5]",
            &["ball", "outside the domain", "move it"][..],
        ),
        (
            "overlap",
            ball,
            "position = [0.06, 0.04, 0.025]",
            &["overlap at the start", "stone", "ball", "relax"],
        ),
        (
            "in_wall",
            stone,
            "position = [0.06, 0.04, 0.005]",
            &["overlap at the start", "stone", "wall_z_min"],
        ),
        (
            "probe",
            "block = \"stone\"",
            "block = \"stoen\"",
            &["probes[0].block", "did you mean `stone`"],
        ),
        (
            "interval",
            "[run]",
            "[coupling]\ninterval = 0\n[run]",
            &["coupling.interval", "at least 1"],
        ),
    ] {
        assert!(CHANNEL.contains(from));
        assert_refused(
            &format!("coupled_{name}"),
            &CHANNEL.replace(from, to),
            words,
        );
    }
}

#[test]
fn phases_of_a_step_are_timed_by_name_and_change_no_bits() {
    let folder = folder("timings");
    go(&args(&folder, CHANNEL, "plain"));
    let timed = riprap(
        &folder,
        &["run", "scene.toml", "--timings", "--out", "timed"],
    );
    let text = said(&timed);
    assert_contains(
        &text,
        &["readback wait", "broadphase", "contact", "integrate"],
    );
    // Passes are timed where the device has timestamps: all or none of them.
    let passes = [
        "voxelise",
        "boundaries",
        "bricks with blocks",
        "reduce",
        "bulk",
    ];
    let timed = passes.map(|pass| text.lines().any(|line| line.starts_with(pass)));
    assert!(timed == [true; 5] || timed == [false; 5], "{text}");
    assert_same_files(&folder, ["plain", "timed"], &["history.csv"]);
}
