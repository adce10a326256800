//! `riprap run` on small scenes of blocks: what it writes, how it ends, and what it refuses.

use crate::fixture::{
    args, assert_refused, assert_same_files, check, folder, go, json, last, read_with_vtk,
    restarted, riprap,
};
use kit::{assert_contains, assert_near};
use riprap_harness::run::run;
use std::{fs, sync::atomic::AtomicBool};

/// Two stacked cubes on a floor, a ball that falls on them, and a cube that is driven past them.
const PILE: &str = r#"
title = "pile"
[[materials]]
name = "rock"
density = 2700
normal_stiffness = 1e8
friction = 30
[[solids]]
kind = "box"
name = "floor"
min = [-3, -3, -1]
max = [3, 3, 0]
[[blocks]]
name = "cube"
kind = "box"
size = [1, 1, 1]
position = [0, 0, 0.5]
repeat = { count = 2, step = [0, 0, 1] }
[[blocks]]
name = "ball"
kind = "sphere"
radius = 0.3
position = [0.1, 0, 2.31]
velocity = [0, 0, -1]
[[blocks]]
name = "sledge"
kind = "box"
size = [0.5, 0.5, 0.5]
position = [-2, 2, 0.5]
motion = "driven"
velocity = ["0.5*t", 0, 0]
[run]
duration = 0.1
[output]
every = 0.05
[[output.histories]]
quantities = ["block_kinetic_energy", "block_potential_energy", "contact_energy", "friction_work", "damping_work", "contact_loss", "outside_work", "energy_error", "contacts", "awake_blocks", "block_max_speed"]
[[probes]]
name = "top"
kind = "block"
block = "cube_2"
every = 0.01
"#;

#[test]
fn a_dry_run_writes_blocks_contacts_tables_and_a_summary() {
    let folder = folder("dry_files");
    let summary = go(&args(&folder, PILE, "out"));
    let out = folder.join("out");
    assert!(summary.complete && !summary.diverged, "{summary}");
    assert!(summary.files.iter().all(|path| path.is_file()));
    for name in [
        "history.csv",
        "history.png",
        "top.csv",
        "blocks.pvd",
        "contacts.pvd",
        "checkpoint.riprap",
    ] {
        assert!(summary.files.contains(&out.join(name)), "{name}");
    }
    let rocks = summary.rocks.as_ref().unwrap();
    assert_eq!((rocks.blocks, rocks.awake), (5, 4));
    assert!(rocks.contacts >= 2);
    assert!(rocks.energy_error.abs() < 1e-2, "{}", rocks.energy_error);
    // Damping only dissipates; the energy that ended contacts held has its own column.
    let (history, ledger) = (out.join("history.csv"), rocks.ledger);
    let damping = ledger.dashpot + ledger.mass_damping + ledger.film;
    assert_eq!(last(&history, "damping_work"), damping);
    assert_eq!(last(&history, "contact_loss"), ledger.contact_loss);

    let blocks = read_with_vtk(&out.join("blocks.pvd"));
    let times: Vec<f64> = blocks["entries"]
        .as_array()
        .unwrap()
        .iter()
        .map(|e| e[0].as_f64().unwrap())
        .collect();
    assert_eq!(times.len(), 3);
    assert_near(times[2], 0.1, 1e-9);
    let cells = blocks["cells"].as_array().unwrap();
    assert_eq!(cells.len(), 5);
    assert!(cells.iter().all(|cell| cell["type"] == 42));
    assert_eq!(
        (&cells[0]["faces"], &cells[0]["points"]),
        (&6.into(), &8.into())
    );
    // Volumes by VTK: two cubes, the ball as a mesh of meridians (2 % less), the sledge, the floor.
    for (cell, volume) in cells.iter().zip([1.0, 1.0, 0.1131 * 0.97, 0.125, 36.0]) {
        let found = cell["volume"].as_f64().unwrap();
        assert_near(found, volume, 0.02 * volume);
    }
    let arrays = blocks["arrays"].as_object().unwrap();
    let fixed: Vec<f64> = arrays["fixed"]
        .as_array()
        .unwrap()
        .iter()
        .map(|v| v[0].as_f64().unwrap())
        .collect();
    assert_eq!(fixed, [0.0, 0.0, 0.0, 0.0, 1.0]);
    let sledge = arrays["velocity"][3][0].as_f64().unwrap();
    assert_near(sledge, 0.05, 1e-6);
    let floor = cells[4]["bounds"].as_array().unwrap();
    assert_eq!(floor[5].as_f64().unwrap(), 0.0);

    // The force of each contact on its second block; their sum presses on the floor.
    let contacts = read_with_vtk(&out.join("contacts.pvd"));
    let count = contacts["points"].as_array().unwrap().len();
    assert_eq!(
        (count as u64, rocks.contacts),
        (contacts["verts"].as_u64().unwrap(), count)
    );
    let mut on_floor = 0.0;
    for k in 0..count {
        let sign = |name: &str| f64::from(u8::from(contacts["arrays"][name][k][0] == 4.0));
        let along = contacts["arrays"]["force"][k][2].as_f64().unwrap();
        on_floor += (sign("second") - sign("first")) * along;
    }
    let net = arrays["contact_force"][4][2].as_f64().unwrap();
    assert!(
        (on_floor - net).abs() < 1e-5 * net.abs() && net < 0.0,
        "{on_floor} {net}"
    );

    let header = fs::read_to_string(out.join("top.csv")).unwrap();
    assert!(header.starts_with(
        "step,time,position_x,position_y,position_z,velocity_x,velocity_y,velocity_z,rotation_x,"
    ));
    assert_near(last(&out.join("top.csv"), "position_z"), 1.5, 2e-3);
    assert_eq!(last(&out.join("history.csv"), "awake_blocks"), 4.0);
    let json = json(&out.join("summary.json"));
    for key in [
        "steps",
        "seconds",
        "diverged",
        "files",
        "rocks",
        "time_step",
        "checkpoint",
    ] {
        assert!(!json[key].is_null(), "{key}");
    }
    assert!(json["mlups"].is_null() && json["cells"].is_null());
    assert_eq!(json["rocks"]["blocks"], 5);
}

#[test]
fn a_restart_of_blocks_goes_on_to_the_same_bits() {
    let folder = folder("dry_restart");
    let text = PILE
        .replace("duration = 0.1", "steps = 60")
        .replace("every = 0.05", "every = 0.01");
    let files = [
        "checkpoint.riprap",
        "blocks_000060.vtu",
        "top.csv",
        "history.csv",
        "blocks.pvd",
        "contacts_000060.vtp",
    ];
    restarted(&folder, &text, 23, &files);
}

#[test]
fn a_run_that_searches_pairs_on_a_device_is_the_same() {
    let folder = folder("dry_device");
    go(&args(&folder, PILE, "host"));
    let title = "title = \"pile\"\n";
    let text = PILE.replace(title, &format!("{title}[rock]\nbroadphase = \"device\"\n"));
    go(&args(&folder, &text, "device"));
    assert_same_files(&folder, ["host", "device"], &["history.csv", "top.csv"]);
}

#[test]
fn a_stopped_run_of_blocks_leaves_its_state() {
    let folder = folder("dry_stop");
    let summary = run(&args(&folder, PILE, "out"), &AtomicBool::new(true)).unwrap();
    assert!(!summary.complete && !summary.diverged);
    assert!(folder.join("out/blocks_000000.vtu").is_file());
}

/// A driven block that crushes another against a wall: the run ends and keeps the last good state.
#[test]
fn a_block_that_is_crushed_ends_the_run_with_names_and_a_state() {
    let folder = folder("dry_crush");
    let text = r#"
        [rock]
        gravity = [0, 0, 0]
        [[materials]]
        name = "soft"
        density = 2000
        normal_stiffness = 1e6
        friction = 20
        [[solids]]
        kind = "box"
        name = "wall"
        min = [1, -2, -2]
        max = [2, 2, 2]
        [[blocks]]
        name = "victim"
        kind = "box"
        size = [1, 1, 1]
        position = [0.5, 0, 0]
        [[blocks]]
        name = "ram"
        kind = "box"
        size = [1, 1, 1]
        position = [-0.6, 0, 0]
        motion = "driven"
        velocity = [1, 0, 0]
        [run]
        duration = 1
    "#;
    let summary = go(&args(&folder, text, "out"));
    assert!(summary.diverged && !summary.complete);
    let message = summary.divergence.as_deref().unwrap();
    assert_contains(message, &["victim", "wall", "overlap by"]);
    let at = summary.steps;
    assert!(at > 0);
    assert_eq!(summary.checkpoint_step, Some(at));
    assert!(folder.join(format!("out/blocks_{at:06}.vtu")).is_file());
    assert!(summary.to_string().contains("--restart"), "{summary}");
    let program = riprap(
        &folder,
        &["run", "--json", "--out", "program", "scene.toml"],
    );
    assert_eq!(program.status.code(), Some(1));
    let json: serde_json::Value = serde_json::from_slice(&program.stdout).unwrap();
    assert_eq!(json["diverged"], true);
}

#[test]
fn what_cannot_be_is_refused_with_what_to_change() {
    let file = folder("dry_mesh_files").join("open.stl");
    fs::write(
        &file,
        "solid open\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n\
         endloop\nendfacet\nendsolid open\n",
    )
    .unwrap();
    let mesh = format!("kind = \"mesh\"\nfile = {:?}", file.display().to_string());
    for (name, from, to, words) in [
        (
            "overlap",
            "step = [0, 0, 1]",
            "step = [0, 0, 0.9]",
            &["cube_1", "cube_2", "1.000e-1 m", "relax"][..],
        ),
        (
            "step",
            "[run]",
            "[rock]\ntime_step = 0.01\n[run]",
            &["time_step", "at most", "cube"],
        ),
        (
            "mesh",
            "kind = \"sphere\"\nradius = 0.3",
            &mesh,
            &["open.stl", "boundary edges", "close its holes"],
        ),
    ] {
        assert!(PILE.contains(from));
        assert_refused(&format!("dry_{name}"), &PILE.replace(from, to), words);
    }
}

/// Its step does not divide the longer duration.
#[test]
fn a_run_that_has_ended_goes_on_with_a_longer_duration() {
    let folder = folder("dry_longer");
    go(&args(&folder, PILE, "out"));
    let longer = PILE.replace("duration = 0.1", "duration = 0.137");
    let mut on = args(&folder, &longer, "on");
    on.restart = Some(folder.join("out/checkpoint.riprap"));
    let summary = go(&on);
    assert!(summary.complete, "{summary}");
    assert_near(last(&folder.join("on/top.csv"), "time"), 0.137, 0.002);
}

#[test]
fn blocks_that_overlap_can_be_pushed_apart() {
    let folder = folder("dry_relax");
    let text = PILE
        .replace("step = [0, 0, 1]", "step = [0, 0, 0.9]")
        .replace(
            "[run]\nduration = 0.1",
            "[rock]\nrelax = true\n[run]\nsteps = 1",
        );
    let summary = go(&args(&folder, &text, "out"));
    assert!(summary.complete);
    let top = last(&folder.join("out/top.csv"), "position_z");
    assert!(top > 1.48, "{top}");
}

#[test]
fn check_says_what_will_run() {
    let (json, text) = check(&folder("dry_check"), PILE);
    for (key, value) in [
        ("blocks", 5),
        ("free", 3),
        ("driven", 1),
        ("fixed", 1),
        ("shapes", 4),
        ("parts", 5),
        ("spheres", 1),
        ("faces", 24),
    ] {
        assert_eq!(json[key], value, "{key}");
    }
    assert!(json["sub_steps"].as_u64().unwrap() >= 10);
    let steps = json["steps"].as_f64().unwrap() * json["time_step"].as_f64().unwrap();
    assert_near(steps, 0.1, 1e-3);
    let words = [
        "5: 3 free, 1 driven, 1 fixed",
        "sub-steps",
        "pairs on the host",
        "ball",
    ];
    assert_contains(text, &words);
}
