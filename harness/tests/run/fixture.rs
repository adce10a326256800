//! Shared by tests of `riprap run`: a folder per test with a scene in it, and readers of the output.

use kit::assert_contains;
use riprap::{output::Table, scene::Kernels};
use riprap_harness::run::{Args, Summary, run};
use serde_json::Value;
use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
    sync::atomic::AtomicBool,
};

/// An empty folder for the test `name`; names differ between all tests that use this.
pub fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Arguments for the scene `text` in `folder`, writing to `folder/NAME`.
pub fn args(folder: &Path, text: &str, out: &str) -> Args {
    let scene = folder.join("scene.toml");
    fs::write(&scene, for_kernels(text)).unwrap();
    Args {
        scene,
        out: Some(folder.join(out)),
        ..Args::default()
    }
}

/// The scene with the kernels given by `RIPRAP_KERNELS`.
fn for_kernels(text: &str) -> String {
    let key = match kit::scene::kernels() {
        Kernels::Auto => return text.into(),
        Kernels::Cpu => "kernels = \"cpu\"",
        Kernels::Gpu => "kernels = \"gpu\"",
    };
    let table = text.replace("[run]\n", &format!("[run]\n{key}\n"));
    let text = table.replace("run = {", &format!("run = {{ {key},"));
    assert!(text.contains(key), "no table `run` in {text}");
    text
}

/// Runs to the end.
pub fn go(args: &Args) -> Summary {
    run(args, &AtomicBool::new(false)).unwrap()
}

/// Runs the scene in one part, into `whole`, and in two parts that are cut after `steps` steps, into `parts`, and asserts
/// that the named files are bitwise equal. The state at the cut is kept in `cut.riprap`. Returns the summary of the whole.
pub fn restarted(folder: &Path, text: &str, steps: u64, files: &[&str]) -> Summary {
    let whole = go(&args(folder, text, "whole"));
    assert!(whole.complete, "{whole}");
    let mut parts = args(folder, text, "parts");
    parts.steps = Some(steps);
    let first = go(&parts);
    assert_eq!(first.checkpoint_step, Some(steps));
    let state = folder.join("cut.riprap");
    fs::copy(first.checkpoint.unwrap(), &state).unwrap();
    parts.restart = Some(state);
    parts.steps = None;
    let second = go(&parts);
    assert_eq!((second.first_step, second.steps), (steps, whole.steps));
    assert_same_files(folder, ["whole", "parts"], files);
    whole
}

/// Asserts that the files of two runs are bitwise equal.
pub fn assert_same_files(folder: &Path, runs: [&str; 2], files: &[&str]) {
    for file in files {
        let [one, two] = runs.map(|run| fs::read(folder.join(run).join(file)).unwrap());
        assert!(one == two, "{file} differs");
    }
}

/// A column of a table.
pub fn column(path: &Path, name: &str) -> Vec<f64> {
    let table = Table::read(path).unwrap();
    table.column(name).unwrap().to_vec()
}

/// The last number of a column.
pub fn last(path: &Path, name: &str) -> f64 {
    *column(path, name).last().unwrap()
}

/// A file of JSON.
pub fn json(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

/// The Python of `harness/python.sh`.
pub fn python() -> PathBuf {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap();
    target.join("python/bin/python")
}

/// The content of a `.vtu`, `.vtp` or `.pvd` as read by VTK.
pub fn read_with_vtk(path: &Path) -> Value {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/run/read_blocks.py");
    let output = Command::new(python())
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

/// Runs the program with these arguments in a folder.
pub fn riprap(folder: &Path, args: &[&str]) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_riprap"));
    program.args(args).current_dir(folder).output().unwrap()
}

/// The error output of the program.
pub fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// The report of `riprap check` on a scene, as JSON and as text.
pub fn check(folder: &Path, text: &str) -> (Value, String) {
    fs::write(folder.join("scene.toml"), text).unwrap();
    let json = riprap(folder, &["check", "scene.toml", "--json"]);
    assert!(json.status.success(), "{}", said(&json));
    let text = riprap(folder, &["check", "scene.toml"]);
    (
        serde_json::from_slice(&json.stdout).unwrap(),
        String::from_utf8(text.stdout).unwrap(),
    )
}

/// Asserts that both `check` and `run` refuse a scene with these words.
#[track_caller]
pub fn assert_refused(name: &str, text: &str, words: &[&str]) {
    let folder = folder(name);
    fs::write(folder.join("scene.toml"), text).unwrap();
    for command in ["check", "run"] {
        let output = riprap(&folder, &[command, "scene.toml"]);
        let told = said(&output);
        assert_eq!(output.status.code(), Some(2), "{command}: {told}");
        assert!(!told.contains("panicked"), "{told}");
        assert_contains(told, words);
    }
}
