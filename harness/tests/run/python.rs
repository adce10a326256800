//! The script of the documentation that reads results into arrays.

use crate::fixture::{folder, python};
use kit::assert_contains;
use std::{env, fs, path::Path, process::Command};

#[test]
fn the_documented_script_runs_and_reads_results() {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/src/python.md");
    let page = fs::read_to_string(page).unwrap();
    let (_, script) = page.split_once("```python\n").unwrap();
    let (script, _) = script.split_once("```").unwrap();
    let program = Path::new(env!("CARGO_BIN_EXE_riprap")).parent().unwrap();
    let path = env::var_os("PATH").unwrap_or_default();
    let paths = [program.to_owned()]
        .into_iter()
        .chain(env::split_paths(&path));
    let output = Command::new(python())
        .args(["-c", script])
        .env("PATH", env::join_paths(paths).unwrap())
        .current_dir(folder("python"))
        .output()
        .expect("run harness/python.sh");
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{complaint}");
    let printed = String::from_utf8_lossy(&output.stdout);
    let lines: Vec<&str> = printed.lines().collect();
    assert_eq!(lines.len(), 2, "{printed}");
    assert_contains(
        lines[0],
        &["0.05 m/s: 100 steps, drag 0.05", "(12, 12, 24)"],
    );
    assert_contains(lines[1], &["0.1 m/s: 100 steps, drag 0.12", "(12, 12, 24)"]);
}
