//! Errors of users: refusals end `riprap check` with code 2, warnings are printed, and both give the place and a remedy.
//! The complete list of refused scenes is in `tests/scene/`.

use std::{
    path::PathBuf,
    process::{Command, Output},
};

/// A valid scene, to be corrupted.
const RIGHT: &str = r#"
[domain]
size = [0.08, 0.08, 0.04]
cell = 0.01

[fluid]
viscosity = 1e-4

[boundaries]
x_min = { kind = "velocity", velocity = [0.01, 0, 0] }
x_max = { kind = "pressure" }
y_min = { kind = "wall" }
y_max = { kind = "wall" }

[run]
steps = 10
"#;

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_TARGET_TMPDIR"))
}

/// `riprap check` on a file in the tests' folder.
fn check(name: &str, text: &str) -> Command {
    let path = folder().join(format!("{name}.toml"));
    std::fs::write(&path, text).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_riprap"));
    command.arg("check").arg(path);
    command
}

/// The message of the program when it refuses.
fn refusal(command: &mut Command) -> String {
    let Output {
        status,
        stderr,
        stdout,
    } = command.output().unwrap();
    let said = String::from_utf8(stderr).unwrap();
    assert_eq!(status.code(), Some(2), "{command:?}: {said}");
    assert!(stdout.is_empty(), "{}", String::from_utf8_lossy(&stdout));
    assert!(!said.contains("panicked"), "{said}");
    said
}

/// A tank with a sill at either end, 15 × 10 particles without them, to be corrupted.
const TANK: &str = r#"
title = "tank"
[domain]
size = [1.2, 1, 1.2]
[fluid]
acceleration = [0, 0, -9.81]
[particles]
spacing = 0.08
plane = true
[boundaries]
x_min = { kind = "wall" }
x_max = { kind = "wall" }
z_min = { kind = "wall" }
z_max = { kind = "open" }
[[water]]
kind = "box"
size = [1.2, 1, 0.8]
position = [0.6, 0.5, 0.4]
[[materials]]
name = "rock"
density = 2500
normal_stiffness = 1e7
friction = 30
[[blocks]]
name = "left"
kind = "box"
size = [0.4, 1, 0.4]
position = [0.2, 0.5, 0.2]
motion = "fixed"
[[blocks]]
name = "right"
kind = "box"
size = [0.4, 1, 0.4]
position = [1, 0.5, 0.2]
motion = "fixed"
[run]
steps = 3
"#;

/// The end of the right sill.
const SILL: &str = "position = [1, 0.5, 0.2]\nmotion = \"fixed\"";

/// Asserts that the refusal of a text contains the name of its file and each of `words`.
#[track_caller]
fn refused(name: &str, text: &str, words: &[&str]) {
    let said = refusal(&mut check(name, text));
    for word in words.iter().chain(&[format!("{name}.toml").as_str()]) {
        assert!(said.contains(word), "`{word}` is not in: {said}");
    }
}

/// The warnings of a text that is accepted.
fn warnings(name: &str, text: &str) -> Vec<String> {
    let Output {
        status,
        stdout,
        stderr,
    } = check(name, text).output().unwrap();
    assert!(status.success(), "{}", String::from_utf8_lossy(&stderr));
    let report = String::from_utf8(stdout).unwrap();
    let lines = report.lines().filter(|line| line.starts_with("warning "));
    lines.map(str::to_owned).collect()
}

#[test]
fn the_scenes_themselves_are_right() {
    assert_eq!(warnings("right", RIGHT), [""; 0]);
    assert_eq!(warnings("right_tank", TANK), [""; 0]);
}

#[test]
fn a_file_that_is_not_there() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_riprap"));
    let said = refusal(command.args(["check", "no_such_scene.toml"]));
    assert!(said.contains("no_such_scene.toml"), "{said}");
    assert!(said.contains("check the path"), "{said}");
}

#[test]
fn a_folder_in_place_of_a_file() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_riprap"));
    let said = refusal(command.arg("check").arg(folder()));
    assert!(said.contains("cannot read the scene"), "{said}");
}

/// One refusal of each stage: the text, the numbers of the lattice, the file of a mesh.
#[test]
fn scenes_are_refused_at_their_key() {
    refused(
        "unknown_key",
        &RIGHT.replace("viscosity =", "viscocity ="),
        &[
            "unknown_key.toml:7:",
            "`viscocity`",
            "did you mean `viscosity`?",
        ],
    );
    refused(
        "mach",
        &format!("{RIGHT}[numerics]\ntime_step = 1\n"),
        &[
            "numerics.time_step",
            "Mach number",
            "use time_step ≤ 5.774e-2 s",
        ],
    );
    let probe = "[[probes]]\nname = \"front\"\nkind = \"face\"\nmin = [0, 0, 0]\nmax = [0.08, 0.08, 0.04]\n\
                 normal = \"+x\"\n";
    refused(
        "face_of_nothing",
        &format!("{RIGHT}{probe}"),
        &["probes.front", "has a solid cell on the side"],
    );
    let open = "solid open\nfacet normal 0 0 1\nouter loop\nvertex 0.02 0.02 0.02\nvertex 0.06 0.02 \
                0.02\nvertex 0.02 0.06 0.03\nendloop\nendfacet\nendsolid open\n";
    std::fs::write(folder().join("open.stl"), open).unwrap();
    let text = RIGHT.to_owned() + "[[solids]]\nkind = \"mesh\"\nfile = \"open.stl\"\n";
    let said = refusal(&mut check("open_mesh", &text));
    for word in ["open.stl", "3 boundary edges", "close its holes"] {
        assert!(said.contains(word), "{said}");
    }
}

/// A scene may have 1.3e8 cells, but the populations of one of 27 directions are 526 MB in f32, and a device with few
/// bindings must hold several of them in each. If the bindings suffice, the limit is that of scenes.
#[test]
fn more_cells_than_the_device_holds() {
    let mut list = Command::new(env!("CARGO_BIN_EXE_riprap"));
    let adapters = list.args(["adapters", "--json"]).output().unwrap().stdout;
    let adapters: serde_json::Value = serde_json::from_slice(&adapters).unwrap();
    let limit = |name: &str| adapters[0]["limits"][name].as_u64().unwrap();
    let binding = limit("storage_binding_bytes").min(limit("buffer_bytes"));
    // Five bindings are taken by the flags and the four results of the output kernel.
    let wants = 525_927_680 * 27_u64.div_ceil(limit("storage_buffers") - 5);
    let (cell, words) = if wants > binding {
        let numbers = format!("wants {wants}, the adapter has {binding}; the adapter holds about");
        let remedy = "use a larger cell, 16-bit storage, or another adapter".into();
        ("cell = 1.25e-4", [numbers, remedy])
    } else {
        let numbers = "1.638e10 cells, more than 4.291e9".into();
        ("cell = 2.5e-5", [numbers, "use cell ≥ 3.908e-5 m".into()])
    };
    let said = refusal(&mut check("large", &RIGHT.replace("cell = 0.01", cell)));
    for word in &words {
        assert!(said.contains(word), "{said}");
    }
}

/// Hides every driver from the program.
fn without_adapters(command: &mut Command) -> &mut Command {
    command
        .env("VK_DRIVER_FILES", "/nonexistent")
        .env("VK_ICD_FILENAMES", "/nonexistent")
        .env("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent")
        .env("LIBGL_DRIVERS_PATH", "/nonexistent")
}

#[cfg(target_os = "linux")]
#[test]
fn a_machine_without_an_adapter() {
    let said = refusal(without_adapters(&mut check("no_adapter", RIGHT)));
    for word in [
        "no GPU adapter",
        "apt-get install mesa-vulkan-drivers libvulkan1",
    ] {
        assert!(said.contains(word), "{said}");
    }
    let mut list = Command::new(env!("CARGO_BIN_EXE_riprap"));
    let said = refusal(without_adapters(list.arg("adapters")));
    assert!(said.contains("apt-get install"), "{said}");
}

#[test]
fn an_adapter_that_does_not_exist() {
    let said = refusal(check("other_adapter", RIGHT).args(["--adapter", "Voodoo 2"]));
    for word in ["no adapter is called 'Voodoo 2'", "there are: "] {
        assert!(said.contains(word), "{said}");
    }
}

#[test]
fn an_unknown_subcommand() {
    let said = refusal(Command::new(env!("CARGO_BIN_EXE_riprap")).arg("chek"));
    assert!(said.contains("check"), "{said}");
}

/// Asserts that the tank with pieces replaced gives a warning in one line with all `words`.
#[track_caller]
fn tank_warned(name: &str, changes: &[(&str, &str)], words: &[&str]) {
    let found = warnings(&format!("water_{name}"), &tank(changes));
    let all = |line: &String| words.iter().all(|word| line.contains(word));
    assert!(
        found.iter().any(all),
        "{words:?} are in no line of: {found:?}"
    );
}

/// The tank with pieces of its text replaced.
fn tank(changes: &[(&str, &str)]) -> String {
    changes.iter().fold(TANK.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    })
}

#[test]
fn free_water_is_warned_of() {
    tank_warned(
        "gap",
        &[("position = [1, 0.5", "position = [0.72, 0.5")],
        &[
            "particles.spacing",
            "1.20e-1 m between `left` and `right`",
            "smaller spacing",
        ],
    );
    let driven = "position = [1, 0.5, 0.2]\nmotion = \"driven\"\nvelocity = [-3, 0, 0]";
    tank_warned(
        "fast",
        &[
            (SILL, driven),
            ("[particles]", "[particles]\nlargest_speed = 1"),
        ],
        &[
            "particles.largest_speed",
            "`right` is driven at",
            "3.000 m/s",
            "give 3.000 m/s",
        ],
    );
    // Without sills nothing contains the water.
    let sills = TANK.find("[[materials]]").unwrap()..TANK.find("[run]").unwrap();
    let faces = "z_min = { kind = \"wall\" }\nz_max = { kind = \"open\" }\n";
    tank_warned(
        "falls",
        &[(&TANK[sills], ""), (faces, "")],
        &["boundaries: gravity", "falls for ever", "kind = \"wall\""],
    );
}

#[test]
fn free_water_is_refused_at_its_key() {
    for (name, from, to, words) in [
        (
            "water_open",
            "z_min = { kind = \"wall\" }",
            "z_min = { kind = \"open\" }",
            ["water[0]", "open face z_min", "kind = \"wall\""],
        ),
        (
            "water_outside",
            "position = [0.6, 0.5, 0.4]",
            "position = [0.9, 0.5, 0.4]",
            ["water[0]", "1.2, 1, 1.2] m", "enlarge the domain"],
        ),
        (
            "water_nan",
            SILL,
            "position = [1, 0.5, 0.2]\nmotion = \"driven\"\nvelocity = [\"sqrt(t - 1)\", 0, 0]",
            ["blocks[1].velocity", "sqrt(t - 1)", "NaN at t = 0"],
        ),
        (
            "water_overlap",
            SILL,
            "position = [0.5, 0.5, 0.2]",
            [
                "overlap at the start",
                "blocks[0] (left) of ",
                "water_overlap.toml:24 and blocks[1] (right) of ",
            ],
        ),
    ] {
        refused(name, &tank(&[(from, to)]), &words);
    }
}
