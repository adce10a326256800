//! What a user gets wrong about free water: refusals end `riprap check` with code 2, warnings are printed, and both say where.

use std::{path::Path, process::Command};

/// A tank with a sill at either end, 15 × 10 particles without them, to be spoilt.
const RIGHT: &str = r#"
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

/// What `riprap check` says of the right scene with `from` replaced by `to`: its exit code, report and complaints.
fn check(name: &str, from: &str, to: &str) -> (Option<i32>, String, String) {
    assert!(RIGHT.contains(from), "{from}");
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("water_{name}.toml"));
    std::fs::write(&path, RIGHT.replace(from, to)).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_riprap"));
    let output = command.arg("check").arg(path).output().unwrap();
    let [report, said] =
        [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
    assert!(!said.contains("panicked"), "{said}");
    (output.status.code(), report, said)
}

#[track_caller]
fn refused(name: &str, from: &str, to: &str, words: &[&str]) {
    let (code, report, said) = check(name, from, to);
    assert!(code == Some(2) && report.is_empty(), "{said}{report}");
    for word in words.iter().chain(&[format!("water_{name}.toml").as_str()]) {
        assert!(said.contains(word), "`{word}` is not in: {said}");
    }
}

#[track_caller]
fn warned(name: &str, from: &str, to: &str, words: &[&str]) {
    let (code, report, said) = check(name, from, to);
    assert_eq!(code, Some(0), "{said}{report}");
    let mut warnings = report.lines().filter(|line| line.starts_with("warning "));
    let all = |line: &str| words.iter().all(|word| line.contains(word));
    assert!(warnings.any(all), "{words:?} are in no line of: {report}");
}

#[test]
fn the_tank_itself_is_right() {
    let (code, report, said) = check("right", "steps = 3", "steps = 3");
    assert!(
        code == Some(0) && !report.contains("warning"),
        "{said}{report}"
    );
}

#[test]
fn a_gap_that_particles_do_not_enter() {
    let words = [
        "particles.spacing",
        "1.20e-1 m between `left` and `right`",
        "smaller spacing",
    ];
    warned("gap", "position = [1, 0.5", "position = [0.72, 0.5", &words);
}

#[test]
fn a_wave_maker_that_is_faster_than_sound_is_set_for() {
    let sill = "position = [1, 0.5, 0.2]\nmotion = \"driven\"\nvelocity = [-3, 0, 0]";
    let text = RIGHT.replace(SILL, sill);
    let text = text.replace("[particles]", "[particles]\nlargest_speed = 1");
    let words = [
        "particles.largest_speed",
        "`right` is driven at",
        "3.000 m/s",
        "give 3.000 m/s",
    ];
    warned("fast", RIGHT, &text, &words);
}

#[test]
fn water_that_nothing_holds() {
    let words = ["boundaries: gravity", "falls for ever", "kind = \"wall\""];
    let sills = RIGHT.find("[[materials]]").unwrap()..RIGHT.find("[run]").unwrap();
    let faces = "z_min = { kind = \"wall\" }\nz_max = { kind = \"open\" }\n";
    let text = RIGHT.replace(&RIGHT[sills], "").replace(faces, "");
    warned("falls", RIGHT, &text, &words);
}

#[test]
fn water_that_stands_on_an_open_face() {
    let words = ["water[0]", "open face z_min", "kind = \"wall\""];
    refused(
        "open",
        "z_min = { kind = \"wall\" }",
        "z_min = { kind = \"open\" }",
        &words,
    );
}

#[test]
fn water_outside_the_domain() {
    let words = [
        "water[0]",
        "extends from",
        "1.2, 1, 1.2] m",
        "enlarge the domain",
    ];
    refused(
        "outside",
        "position = [0.6, 0.5, 0.4]",
        "position = [0.9, 0.5, 0.4]",
        &words,
    );
}

#[test]
fn a_block_in_another() {
    let (code, _, said) = check("overlap", SILL, "position = [0.5, 0.5, 0.2]");
    assert_eq!(code, Some(2), "{said}");
    for word in [
        "overlap at the start",
        "blocks[0] (left) of ",
        "water_overlap.toml:24 and blocks[1] (right) of ",
        "water_overlap.toml:30 by",
        "move them apart",
    ] {
        assert!(said.contains(word), "`{word}` is not in: {said}");
    }
}

#[test]
fn a_wave_maker_whose_formula_is_no_number() {
    let words = ["blocks[1].velocity", "sqrt(t - 1)", "NaN at t = 0"];
    let to = "position = [1, 0.5, 0.2]\nmotion = \"driven\"\nvelocity = [\"sqrt(t - 1)\", 0, 0]";
    refused("nan", SILL, to, &words);
}
