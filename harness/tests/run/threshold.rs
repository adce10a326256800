//! `riprap threshold` on scenes with a known threshold, and its refusals.

use crate::fixture::{folder, json, riprap, said};
use kit::{assert_contains, assert_near};
use riprap_harness::threshold::{Args, Report, run};
use std::{fs, path::Path, sync::atomic::AtomicBool};

/// A cube on a plane under gravity with a component along the plane: it slides once that exceeds the friction of 30°,
/// g tan 30° = 5.664 m/s².
const SLIDE: &str = r#"
[rock]
gravity = [0, 0, -9.81]
[[materials]]
name = "rock"
density = 2700
normal_stiffness = 1e9
friction = 30
[[solids]]
kind = "box"
name = "plane"
min = [-1, -1, -1]
max = [1, 1, 0]
[[blocks]]
name = "cube"
kind = "box"
size = [0.1, 0.1, 0.1]
position = [0, 0, 0.05]
[[blocks]]
name = "held"
kind = "box"
size = [0.1, 0.1, 0.1]
position = [0, 0.5, 0.05]
motion = "fixed"
[run]
duration = 0.2
"#;

/// A ball on the bed of a short channel, in front of a ridge.
const PUSH: &str = r#"
[domain]
size = [0.16, 0.08, 0.08]
cell = 0.01
[fluid]
viscosity = 1e-3
[numerics]
velocity_scale = 3
[boundaries]
x_min = { kind = "velocity", velocity = [0, 0, 0] }
x_max = { kind = "pressure" }
z_min = { kind = "wall" }
z_max = { kind = "free_slip" }
[[materials]]
name = "rock"
density = 2650
normal_stiffness = 1e6
friction = 40
[[blocks]]
name = "plate"
kind = "box"
size = [0.04, 0.04, 0.04]
position = [0.06, 0.04, 0.02]
[run]
steps = 60
"#;

fn args(folder: &Path, text: &str, key: &[&str], [from, to, tolerance]: [f64; 3]) -> Args {
    let scene = folder.join("scene.toml");
    fs::write(&scene, text).unwrap();
    Args {
        scene,
        key: key.iter().map(|key| (*key).into()).collect(),
        from,
        to,
        tolerance,
        out: Some(folder.join("out")),
        ..Args::default()
    }
}

fn go(args: &Args) -> Report {
    run(args, &AtomicBool::new(false)).unwrap()
}

#[test]
fn a_block_slides_where_its_friction_gives_way() {
    let folder = folder("threshold_slide");
    let args = args(&folder, SLIDE, &["rock.gravity[0]"], [4.0, 8.0, 0.1]);
    let report = go(&args);
    let [still, moves] = report.bracket.unwrap();
    assert!(report.complete && moves - still <= 0.1, "{report}");
    // In 0.2 s an excess a moves it ½ a t²: a millimetre takes 0.05 m/s².
    let slides = 9.81 * 30f64.to_radians().tan();
    assert!(still < slides + 0.06 && slides < moves, "{report}");
    assert_eq!(report.trials.len(), 8);
    let first = report.trials[1].moved.as_ref().unwrap();
    assert_eq!(first.block, "cube");
    // From rest at 8 − 5.664 m/s²: a millimetre after √(2 · 0.001/2.336) s, checked every 200th of the run.
    assert_near(first.time, 0.02926, 0.0015);
    assert!(report.trials[0].moved.is_none());
    let table = fs::read_to_string(folder.join("out/threshold.csv")).unwrap();
    assert_eq!(table.lines().count(), 9);
    let json = json(&folder.join("out/threshold.json"));
    assert_eq!(json["bracket"][0], still);
    assert!(report.to_string().contains("the threshold is"), "{report}");
}

#[test]
fn a_criterion_of_speed_and_a_settled_start_give_the_same_threshold() {
    let folder = folder("threshold_speed");
    let args = Args {
        speed: Some(5e-3),
        settle: Some(0.05),
        block: Some("cube".into()),
        ..args(&folder, SLIDE, &["rock.gravity[0]"], [4.0, 8.0, 0.2])
    };
    let report = go(&args);
    let [still, moves] = report.bracket.unwrap();
    let slides = 9.81 * 30f64.to_radians().tan();
    // 5 mm/s after 0.2 s: 0.025 m/s².
    assert!(still < slides + 0.03 && slides < moves, "{report}");
    assert!(folder.join("out/settled.riprap").is_file());
}

/// The settled state would replace what these keys change.
#[test]
fn keys_of_the_start_are_refused_with_a_settled_start() {
    let folder = folder("threshold_start");
    for (key, block) in [
        ("blocks.cube.position[2]", "`cube`"),
        ("blocks.cube.size[2]", "`cube`"),
        ("blocks.cube.velocity[0]", "`cube`"),
        ("solids.plane.max[0]", "`plane`"),
    ] {
        let moving = SLIDE.replacen("[0, 0, 0.05]", "[0, 0, 0.05]\nvelocity = [0, 0, 0]", 1);
        let args = Args {
            settle: Some(0.01),
            ..args(&folder, &moving, &[key], [0.05, 0.06, 0.001])
        };
        let refused = run(&args, &AtomicBool::new(false)).unwrap_err();
        assert_contains(refused, &["--settle: the key changes", block]);
    }
}

#[test]
fn a_block_that_was_under_way_at_the_end_is_said() {
    let folder = folder("threshold_under_way");
    // In 0.2 s an excess of 0.3 m/s² moves it 6 mm, a fifth of the criterion, and its speed covers 12 mm in the same time:
    // at 0.45 m/s² and more, 9 and 18 mm, another trial would detect it.
    let args = Args {
        distance: Some(0.027),
        ..args(&folder, SLIDE, &["rock.gravity[0]"], [4.0, 8.0, 0.1])
    };
    let report = go(&args);
    let [still, _] = report.bracket.unwrap();
    assert!((6.9..7.1).contains(&still), "{report}");
    let told = report.to_string();
    assert_contains(&told, &["cube was under way", "lower the threshold"]);
    assert!(!report.trials[0].under_way && report.trials.iter().any(|trial| trial.under_way));
    let json = fs::read_to_string(folder.join("out/threshold.json")).unwrap();
    assert!(json.contains("\"warning\": \"at "), "{json}");
    // Together with the value reported besides the bracket, it contains the true threshold.
    let slides = 9.81 * 30f64.to_radians().tan();
    let rest = report.rest.unwrap();
    assert!(rest <= slides && slides < still, "{rest}");
    assert!(told.contains(&format!("at {rest} none came")), "{told}");
}

#[test]
fn a_flow_that_is_fast_enough_moves_a_block() {
    let folder = folder("threshold_push");
    let key = "boundaries.x_min.velocity[0]";
    let args = Args {
        settle: Some(0.01),
        equilibrium: true,
        ..args(&folder, PUSH, &[key], [0.0, 3.0, 1.6])
    };
    let report = go(&args);
    // By the mean loads of the trial at half of the highest speed, in which the ball stood, or none if the flow was at rest.
    let still = report.trials.iter().filter(|trial| trial.moved.is_none());
    let found: Vec<_> = still.map(|trial| trial.equilibrium.as_ref()).collect();
    assert!(found[0].is_none(), "{report:?}");
    let text = report.to_string();
    assert_eq!(
        found.len() > 1,
        text.contains("in limit equilibrium"),
        "{text}"
    );
    assert!(report.complete, "{report}");
    assert_eq!(report.trials.len(), 3);
    assert!(report.trials[1].moved.is_some(), "{report:?}");
    assert!(report.trials[0].steps == 60 && report.trials[1].steps < 60);
}

#[test]
fn a_formula_at_the_key_is_multiplied() {
    let folder = folder("threshold_formula");
    let text = PUSH
        .replace(
            "velocity = [0, 0, 0]",
            "velocity = [\"0.1*min(1, z/0.02)\", 0, 0]",
        )
        .replace("[run]\nsteps = 60", "[run]\nsteps = 40");
    let key = "boundaries.x_min.velocity[0]";
    let report = go(&args(&folder, &text, &[key], [0.0, 30.0, 16.0]));
    assert!(report.complete, "{report}");
    let [still, moves] = report.bracket.unwrap();
    // Factors of a profile of 0.1 m/s: a speed of 30 m/s would be refused.
    assert!(0.0 <= still && moves <= 30.0, "{report}");
    assert!(report.trials[1].moved.is_some() && report.trials[0].moved.is_none());
}

#[test]
fn what_cannot_be_searched_is_refused() {
    let folder = folder("threshold_refused");
    fs::write(folder.join("scene.toml"), SLIDE).unwrap();
    let gravity = "rock.gravity[0]";
    for (key, from, to, more, words) in [
        (
            "rock.gravity[5]",
            "4",
            "8",
            &[][..],
            &["no [5] among 3"][..],
        ),
        ("rock.gravty[0]", "4", "8", &[], &["no `gravty`"]),
        (
            "materials[0].name",
            "4",
            "8",
            &[],
            &["neither a number nor a formula", "rock"],
        ),
        (
            gravity,
            "4",
            "8",
            &["--block", "held"],
            &["--block", "cube"],
        ),
        (gravity, "7", "8", &[], &["moves at 7 already", "--from"]),
        (gravity, "-1", "2", &[], &["no block moves at 2", "--to"]),
        (gravity, "3", "3", &[], &["nothing between"]),
        (
            gravity,
            "4",
            "8",
            &["--equilibrium"],
            &["--equilibrium", "no fluid"],
        ),
    ] {
        let ends = ["--from", from, "--to", to, "--tolerance", "0.5"];
        let search = ["threshold", "scene.toml", "--key", key];
        let program = riprap(&folder, &[&search[..], &ends, more].concat());
        assert_eq!(program.status.code(), Some(2), "{}", said(&program));
        assert_contains(said(&program), words);
    }
}
