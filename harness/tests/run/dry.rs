//! `riprap run` on small scenes of blocks: what it writes, how it ends, and what it refuses.

use crate::fixture::{args, folder, go};
use riprap::output::Table;
use riprap_harness::run::{Args, run};
use std::{fs, path::Path, process::Command, sync::atomic::AtomicBool};

/// Two cubes that lie on each other on a floor, a ball that falls on them, and a cube that is driven
/// past them.
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

/// What VTK finds in a `.vtu`, `.vtp` or `.pvd`.
fn read_with_vtk(path: &Path) -> serde_json::Value {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap();
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/run/read_blocks.py");
    let output = Command::new(target.join("python/bin/python"))
        .arg(script)
        .arg(path)
        .output()
        .expect("run harness/python.sh");
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.success() && complaint.is_empty(),
        "VTK: {complaint}"
    );
    serde_json::from_slice(&output.stdout).unwrap()
}

fn last(path: &Path, column: &str) -> f64 {
    *Table::read(path)
        .unwrap()
        .column(column)
        .unwrap()
        .last()
        .unwrap()
}

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
    // Damping only takes; what ended contacts held is a column of its own.
    let (history, ledger) = (out.join("history.csv"), rocks.ledger);
    let damping = ledger.dashpot + ledger.mass_damping + ledger.film;
    assert_eq!(last(&history, "damping_work"), damping);
    assert_eq!(last(&history, "contact_loss"), ledger.lost);

    let blocks = read_with_vtk(&out.join("blocks.pvd"));
    let times: Vec<f64> = blocks["entries"]
        .as_array()
        .unwrap()
        .iter()
        .map(|e| e[0].as_f64().unwrap())
        .collect();
    assert_eq!(times.len(), 3);
    assert!((times[2] - 0.1).abs() < 1e-9, "{times:?}");
    let cells = blocks["cells"].as_array().unwrap();
    assert_eq!(cells.len(), 5);
    assert!(cells.iter().all(|cell| cell["type"] == 42));
    assert_eq!(
        (&cells[0]["faces"], &cells[0]["points"]),
        (&6.into(), &8.into())
    );
    // VTK's volumes: two cubes, the ball between meridians (2 % short), the sledge, the floor.
    for (cell, volume) in cells.iter().zip([1.0, 1.0, 0.1131 * 0.97, 0.125, 36.0]) {
        let found = cell["volume"].as_f64().unwrap();
        assert!(
            (found - volume).abs() < 0.02 * volume,
            "{found} for {volume}"
        );
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
    assert!((sledge - 0.05).abs() < 1e-6, "{sledge}");
    let floor = cells[4]["bounds"].as_array().unwrap();
    assert_eq!(floor[5].as_f64().unwrap(), 0.0);

    // Each contact's force on its second block; all together hold the floor down.
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
    assert!((last(&out.join("top.csv"), "position_z") - 1.5).abs() < 2e-3);
    assert_eq!(last(&out.join("history.csv"), "awake_blocks"), 4.0);
    let json: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(out.join("summary.json")).unwrap()).unwrap();
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
    assert!(go(&args(&folder, &text, "whole")).complete);
    let mut parts = args(&folder, &text, "parts");
    parts.steps = Some(23);
    let first = go(&parts);
    assert_eq!(first.checkpoint_step, Some(23));
    parts.restart = first.checkpoint;
    parts.steps = None;
    let second = go(&parts);
    assert_eq!((second.first_step, second.steps), (23, 60));
    for name in [
        "checkpoint.riprap",
        "blocks_000060.vtu",
        "top.csv",
        "history.csv",
        "blocks.pvd",
        "contacts_000060.vtp",
    ] {
        let [one, two] =
            ["whole", "parts"].map(|out| fs::read(folder.join(out).join(name)).unwrap());
        assert!(one == two, "{name} differs");
    }
}

#[test]
fn a_run_that_searches_pairs_on_a_device_is_the_same() {
    let folder = folder("dry_device");
    let on_host = args(&folder, PILE, "host");
    go(&on_host);
    let title = "title = \"pile\"\n";
    let text = PILE.replace(title, &format!("{title}[rock]\nbroadphase = \"device\"\n"));
    let on_device = args(&folder, &text, "device");
    go(&on_device);
    for table in ["history.csv", "top.csv"] {
        let read = |args: &Args| fs::read(args.out.as_ref().unwrap().join(table)).unwrap();
        assert!(read(&on_host) == read(&on_device), "{table}");
    }
}

#[test]
fn a_stopped_run_of_blocks_leaves_its_state() {
    let folder = folder("dry_stop");
    let summary = run(&args(&folder, PILE, "out"), &AtomicBool::new(true)).unwrap();
    assert!(!summary.complete && !summary.diverged);
    assert!(folder.join("out/blocks_000000.vtu").is_file());
}

/// A driven block that crushes another against a wall: the run ends, the last good state stays.
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
    let args = args(&folder, text, "out");
    let summary = go(&args);
    assert!(summary.diverged && !summary.complete);
    let told = summary.divergence.as_deref().unwrap();
    for part in ["victim", "ram", "overlap by"] {
        assert!(told.contains(part), "`{part}` is not in: {told}");
    }
    let at = summary.steps;
    assert!(at > 0);
    assert_eq!(summary.checkpoint_step, Some(at));
    assert!(folder.join(format!("out/blocks_{at:06}.vtu")).is_file());
    assert!(summary.to_string().contains("--restart"), "{summary}");
    let program = Command::new(env!("CARGO_BIN_EXE_riprap"))
        .args(["run", "--json", "--out"])
        .arg(folder.join("program"))
        .arg(&args.scene)
        .output()
        .unwrap();
    assert_eq!(program.status.code(), Some(1));
    let json: serde_json::Value = serde_json::from_slice(&program.stdout).unwrap();
    assert_eq!(json["diverged"], true);
}

/// What the program says when it refuses `command` on a scene.
fn refusal(command: &str, name: &str, text: &str) -> String {
    let scene = folder(&format!("dry_{name}")).join("scene.toml");
    fs::write(&scene, text).unwrap();
    let program = Command::new(env!("CARGO_BIN_EXE_riprap"))
        .arg(command)
        .arg(&scene)
        .arg("--json")
        .current_dir(folder(&format!("dry_{name}_out")))
        .output()
        .unwrap();
    let told = String::from_utf8(program.stderr).unwrap();
    assert_eq!(program.status.code(), Some(2), "{told}");
    assert!(!told.contains("panicked"), "{told}");
    told
}

#[track_caller]
fn refused(name: &str, from: &str, to: &str, words: &[&str]) {
    assert!(PILE.contains(from));
    for command in ["check", "run"] {
        let told = refusal(command, name, &PILE.replace(from, to));
        for word in words {
            assert!(told.contains(word), "`{word}` is not in: {told}");
        }
    }
}

#[test]
fn blocks_that_overlap_at_the_start_are_named_with_depths() {
    refused(
        "overlap",
        "step = [0, 0, 1]",
        "step = [0, 0, 0.9]",
        &["cube_1", "cube_2", "1.000e-1 m", "relax"],
    );
}

#[test]
fn a_time_step_beyond_the_bound_is_refused_with_the_bound() {
    refused(
        "step",
        "[run]",
        "[rock]\ntime_step = 0.01\n[run]",
        &["time_step", "at most", "cube"],
    );
}

#[test]
fn meshes_that_enclose_nothing_are_refused() {
    let dir = folder("dry_mesh_files");
    let file = dir.join("open.stl");
    fs::write(
        &file,
        "solid open\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n\
         endloop\nendfacet\nendsolid open\n",
    )
    .unwrap();
    let mesh = format!("kind = \"mesh\"\nfile = {:?}", file.display().to_string());
    refused(
        "mesh",
        "kind = \"sphere\"\nradius = 0.3",
        &mesh,
        &["open.stl", "boundary edges", "close its holes"],
    );
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
    let scene = folder("dry_check").join("scene.toml");
    fs::write(&scene, PILE).unwrap();
    let check = |more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_riprap"));
        let output = command
            .arg("check")
            .arg(&scene)
            .args(more)
            .output()
            .unwrap();
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        String::from_utf8(output.stdout).unwrap()
    };
    let json: serde_json::Value = serde_json::from_str(&check(&["--json"])).unwrap();
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
    assert!((steps - 0.1).abs() < 1e-3);
    let text = check(&[]);
    for word in [
        "5: 3 free, 1 driven, 1 fixed",
        "sub-steps",
        "pairs on the host",
        "ball",
    ] {
        assert!(text.contains(word), "`{word}` is not in:\n{text}");
    }
}
