//! `riprap run` on small lattice scenes: output and ends of runs.

use crate::fixture::{args, column, folder, go, json, restarted, riprap, said};
use kit::assert_contains;
use riprap::Error;
use riprap_harness::run::{Args, Schedule, Unfinished, run};
use std::{fs, path::Path, sync::atomic::AtomicBool};

/// The first line of a table.
fn header(path: &Path) -> String {
    let text = fs::read_to_string(path).unwrap();
    text.lines().next().unwrap_or_default().to_owned()
}

/// A step in a channel with everything that belongs to a state: an unsteady inlet, an outlet with memory, an eddy
/// viscosity, a solid.
const STEP: &str = r#"
    [domain]
    size = [0.24, 0.12, 0.04]
    cell = 0.01
    [fluid]
    viscosity = 1e-4
    [numerics]
    eddy_viscosity = "wale"
    velocity_scale = 1
    [boundaries]
    x_min = { kind = "velocity", velocity = ["0.5 + 5*t", 0, 0] }
    x_max = { kind = "pressure" }
    y_min = { kind = "wall" }
    y_max = { kind = "free_slip" }
    [[solids]]
    kind = "box"
    name = "step"
    min = [0.1, 0, 0]
    max = [0.14, 0.04, 0.04]
    [run]
    steps = 24
    [output]
    every = 0.005
    fields = ["velocity", "pressure", "eddy_viscosity"]
    [[output.histories]]
    quantities = ["kinetic_energy", "mass", "max_speed"]
    [[output.slices]]
    name = "speed"
    axis = "z"
    field = "speed"
    streamlines = true
    every = 1
    [[probes]]
    name = "front"
    kind = "face"
    min = [0.08, 0, 0]
    max = [0.1, 0.04, 0.04]
    normal = "-x"
    every = 0.001
    [[probes]]
    name = "above"
    kind = "box"
    min = [0.1, 0.04, 0]
    max = [0.14, 0.12, 0.04]
    fields = ["velocity", "eddy_viscosity"]
    every = 0.002
    [[probes]]
    name = "along"
    kind = "line"
    from = [0, 0.08, 0.02]
    to = [0.24, 0.08, 0.02]
    count = 5
"#;

/// A flow driven by a force beyond the range of the lattice.
const RUNAWAY: &str = r#"
    [domain]
    size = [0.08, 0.08, 0.08]
    cell = 0.01
    [fluid]
    viscosity = 1e-3
    acceleration = [5, 0, 0]
    [numerics]
    velocity_scale = 0.1
    [run]
    steps = 400
    checkpoint_every = 0.05
    [[output.histories]]
    quantities = ["max_speed"]
"#;

#[test]
fn the_couette_scene_writes_what_it_asks_for() {
    let folder = folder("run_couette");
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/couette.toml");
    let mut args = args(&folder, &fs::read_to_string(shipped).unwrap(), "out");
    args.steps = Some(170);
    let summary = go(&args);
    let out = folder.join("out");
    let expected = [
        "history.csv",
        "profile.csv",
        "fields.pvd",
        "fields_000170.vti",
        "speed_000170.png",
        "checkpoint.riprap",
        "history.png",
        "summary.json",
    ];
    let mut expected = expected.map(|name| out.join(name));
    expected.sort();
    let mut files = summary.files.clone();
    files.sort();
    assert_eq!(files, expected);
    assert!(summary.files.iter().all(|path| path.is_file()));
    assert_eq!(
        header(&out.join("profile.csv")),
        "step,time,s,x,y,z,velocity_x,velocity_y,velocity_z"
    );
    assert_eq!(
        header(&out.join("history.csv")),
        "step,time,kinetic_energy,momentum_x"
    );
    let speed = column(&out.join("profile.csv"), "velocity_x");
    assert_eq!(speed.len(), 32);
    assert!(speed.is_sorted(), "the plate drags the fluid along");
    assert_eq!(
        (summary.steps, summary.complete, summary.diverged),
        (170, true, false)
    );
    let lattice = summary.lattice.unwrap();
    assert_eq!((lattice.fluid_cells, lattice.bytes_per_cell), (2048, 216));
    // The keys of summary.json are a public interface.
    let keys = serde_json::to_value(&lattice).unwrap();
    assert_eq!(keys["bytes_a_cell"], 216);
    assert!(keys["bytes_a_step"].is_u64());
    assert!(lattice.mlups > 0.0 && lattice.bandwidth_share > 0.0);
    // The plate has Mach 0.1, the fluid next to it less.
    let mach = lattice.max_mach;
    assert!((0.05..0.1).contains(&mach), "{mach}");
    let json = json(&out.join("summary.json"));
    for key in [
        "steps",
        "seconds",
        "mlups",
        "bandwidth_share",
        "max_mach",
        "diverged",
        "files",
    ] {
        assert!(!json[key].is_null(), "{key}");
    }
}

#[test]
fn a_restart_goes_on_to_the_same_bits() {
    let folder = folder("run_restart");
    let files = [
        "checkpoint.riprap",
        "front.csv",
        "above.csv",
        "along.csv",
        "history.csv",
        "fields_000024.vti",
        "fields.pvd",
    ];
    restarted(&folder, STEP, 13, &files);
    assert_eq!(
        header(&folder.join("whole/front.csv")),
        "step,time,area,pressure_mean,pressure_min,pressure_max,force,x_of_max,y_of_max,z_of_max"
    );
}

#[test]
fn a_stopped_run_leaves_its_state_and_all_its_outputs() {
    let folder = folder("run_stop");
    let mut args = args(&folder, STEP, "out");
    args.steps = Some(7);
    let before = fs::read(go(&args).checkpoint.unwrap()).unwrap();
    args.restart = Some(folder.join("out/checkpoint.riprap"));
    args.steps = None;
    let summary = run(&args, &AtomicBool::new(true)).unwrap();
    assert_eq!(
        (summary.steps, summary.complete, summary.diverged),
        (7, false, false)
    );
    assert_eq!(summary.checkpoint_step, Some(7));
    assert!(fs::read(summary.checkpoint.unwrap()).unwrap() == before);
    assert_eq!(column(&folder.join("out/along.csv"), "step"), [7.0; 5]);
}

#[test]
fn a_flow_that_diverges_says_where_and_why_and_keeps_what_there_is() {
    let folder = folder("run_diverge");
    let summary = go(&args(&folder, RUNAWAY, "out"));
    assert!(summary.diverged && !summary.complete);
    let told = summary.divergence.as_deref().unwrap();
    assert_contains(told, &["diverged at step ", "in cell (", " m: ", "; "]);
    let last_good = summary.checkpoint_step.unwrap();
    assert!(0 < last_good && last_good < summary.steps);
    assert!(folder.join("out/checkpoint.riprap").is_file());
    assert!(folder.join("out/summary.json").is_file());
    assert!(summary.to_string().contains("--restart"), "{summary}");
    let program = riprap(
        &folder,
        &["run", "--json", "--out", "program", "scene.toml"],
    );
    assert_eq!(program.status.code(), Some(1));
    let json: serde_json::Value = serde_json::from_slice(&program.stdout).unwrap();
    assert_eq!(json["diverged"], true);
    assert_contains(said(&program), &["\nerror: diverged at step "]);
}

#[test]
fn a_flow_that_diverges_unprepared_has_a_state_to_go_on_from() {
    let folder = folder("run_unprepared");
    let text = RUNAWAY.replace("checkpoint_every = 0.05", "");
    let mut args = args(&folder, &text, "out");
    let summary = go(&args);
    assert!(summary.diverged, "{summary}");
    let step = summary.checkpoint_step.unwrap();
    // It diverges in the first tenth of 400 steps, which has a checkpoint every 4 steps.
    assert!(step > 0 && step.is_multiple_of(4) && summary.steps - step <= 4);
    let file = summary.checkpoint.clone().unwrap();
    let told = format!("--restart {}` goes on from step {step}", file.display());
    assert!(summary.to_string().contains(&told), "{summary}");
    args.restart = Some(file);
    args.steps = Some(step + 2);
    let rest = go(&args);
    assert!(rest.complete && rest.first_step == step, "{rest}");
}

/// The message of a run that is refused before it starts.
#[track_caller]
fn refusal(args: &Args) -> String {
    let error = run(args, &AtomicBool::new(false)).unwrap_err();
    assert!(error.downcast_ref::<Unfinished>().is_none(), "{error:#}");
    assert!(error.downcast_ref::<Error>().is_some(), "{error:#}");
    format!("{error:#}")
}

#[test]
fn a_folder_that_cannot_be_made_is_refused() {
    let folder = folder("run_folder");
    fs::write(folder.join("file"), "").unwrap();
    let told = refusal(&args(&folder, STEP, "file/out"));
    assert!(told.contains("--out"), "{told}");
}

#[test]
fn a_checkpoint_that_does_not_fit_is_refused() {
    let folder = folder("run_wrong");
    let mut restart = args(&folder, STEP, "out");
    restart.restart = Some(restart.scene.clone());
    let told = refusal(&restart);
    assert!(told.contains("not a checkpoint"), "{told}");
    restart.restart = Some(folder.join("nowhere"));
    let told = refusal(&restart);
    assert!(told.contains("nowhere"), "{told}");
    restart.restart = None;
    restart.steps = Some(2);
    restart.restart = go(&restart).checkpoint;
    let told = refusal(&restart);
    assert_contains(&told, &["step 2", "--steps"]);
    fs::write(&restart.scene, STEP.replace("[0.24,", "[0.25,")).unwrap();
    restart.steps = Some(9);
    let told = refusal(&restart);
    assert!(told.contains("cells"), "{told}");
}

#[test]
fn wrong_input_ends_the_program_with_2_and_one_line() {
    let folder = folder("run_input");
    args(
        &folder,
        &STEP.replace("viscosity = 1e-4", "viscocity = 1e-4"),
        "out",
    );
    let program = riprap(&folder, &["run", "scene.toml"]);
    assert_eq!(program.status.code(), Some(2));
    let told = said(&program);
    assert!(
        told.starts_with("error: ") && told.lines().count() == 1,
        "{told}"
    );
    assert!(told.contains("viscosity"), "{told}");
}

#[test]
fn multiples_of_an_interval_do_not_drift_and_the_last_step_counts() {
    const TIME_STEP: f64 = 0.3;
    let schedule = Schedule::new(Some(1.0), TIME_STEP, 11);
    let due: Vec<u64> = (0..=11).filter(|step| schedule.due(*step)).collect();
    // 0, 1, 2 and 3 s in steps of 0.3 s, and the end.
    assert_eq!(due, [0, 3, 7, 10, 11]);
    let mut passed = vec![0];
    while *passed.last().unwrap() < 11 {
        passed.push(schedule.next(*passed.last().unwrap()));
    }
    assert_eq!(passed, due);
    let end = Schedule::new(None, TIME_STEP, 11);
    assert_eq!((end.due(0), end.next(0), end.due(11)), (false, 11, true));
    let dense = Schedule::new(Some(0.1), TIME_STEP, 11);
    assert!((0..=11).all(|step| dense.due(step)));
}

/// A wall law on the bed and on the step: its table, its surface and its line in the summary, also over a restart.
#[test]
fn walls_with_a_wall_model() {
    let folder = folder("lattice_wall_model");
    let text = STEP
        .replace("viscosity = 1e-4", "viscosity = 1e-6")
        .replace("wale\"", "wale\"\n    wall_model = \"reichardt\"")
        .replace(
            "y_min = { kind = \"wall\" }",
            "y_min = { kind = \"wall\", roughness = 0.002 }",
        )
        .replace("name = \"step\"", "name = \"step\"\n    roughness = 0.001");
    let summary = restarted(
        &folder,
        &text,
        13,
        &["walls.csv", "walls_000024.vtp", "fields_000024.vti"],
    );
    let walls = summary.wall_model.expect("the scene has a wall model");
    // On the bed 22 × 4 faces lie away from inlet and outlet, 6 of these rows next to the step or in it; two columns of the
    // step's top have no edge, and its sides are too low.
    assert!(walls.area_share > 0.5 && walls.area_share < 0.9, "{walls}");
    assert!(
        walls.y_plus_max > 50.0 && walls.stress_mean > 0.0,
        "{walls}"
    );
    assert_contains(&summary, &["wall model on "]);
    let table = folder.join("whole/walls.csv");
    assert!(header(&table).starts_with("step,time,y_min_area,y_min_stress_x"));
    let (bed, step) = (
        column(&table, "y_min_stress_x"),
        column(&table, "solids_stress_x"),
    );
    assert!(
        bed.last() > Some(&0.0) && step.last() > Some(&0.0),
        "{bed:?} {step:?}"
    );
}
