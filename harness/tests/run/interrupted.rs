//! Runs that end early: killed, or with a full disk. The files on disk continue to the same bits. Runs that do not fit in
//! memory are refused with a message.

use crate::fixture::{assert_same_files, folder, said};
use kit::assert_contains;
use riprap::wgpu;
use riprap_harness::gpu;
use std::{
    fs,
    path::Path,
    process::Command,
    time::{Duration, Instant},
};

/// A stone carried along by a stream.
const SCENE: &str = r#"
[domain]
size = [0.08, 0.04, 0.04]
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
size = [0.015, 0.015, 0.015]
position = [0.03, 0.02, 0.0075]
[run]
steps = STEPS
checkpoint_every = 0.01
[output]
every = 0.05
[[output.histories]]
quantities = ["kinetic_energy", "block_kinetic_energy"]
every = 0.005
"#;

/// The program with the scene and this number of steps, not started yet.
fn riprap(folder: &Path, steps: u64, out: &str) -> Command {
    let scene = folder.join("scene.toml");
    fs::write(&scene, SCENE.replace("STEPS", &steps.to_string())).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_riprap"));
    command.arg("run").arg(&scene).arg("--out");
    command.arg(folder.join(out));
    command
}

#[test]
fn a_folder_is_for_one_run_at_a_time() {
    let folder = folder("locked");
    let out = folder.join("out");
    fs::create_dir_all(&out).unwrap();
    let other = fs::File::open(&out).unwrap();
    other.lock().unwrap();
    let refused = riprap(&folder, 1, "out").output().unwrap();
    assert!(!refused.status.success());
    assert_contains(said(&refused), &["another run", "--out"]);
    drop(other);
    let output = riprap(&folder, 1, "out").output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
}

#[test]
fn a_run_that_is_killed_goes_on_to_the_same_bits() {
    let folder = folder("killed");
    // Enough steps that it does not end by itself.
    let mut child = riprap(&folder, 1_000_000, "cut");
    let mut child = child
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    let state = folder.join("cut/checkpoint.riprap");
    let begin = Instant::now();
    while !state.exists() {
        assert!(child.try_wait().unwrap().is_none(), "it ended by itself");
        assert!(begin.elapsed() < Duration::from_secs(240), "no checkpoint");
        std::thread::sleep(Duration::from_millis(20));
    }
    // SIGKILL: no handler runs.
    child.kill().unwrap();
    child.wait().unwrap();
    let saved = riprap::simulation::checkpoint::Checkpoint::read(&state).unwrap();
    let last = saved.step + 37;
    let mut more = riprap(&folder, last, "cut");
    let more = more.arg("--restart").arg(&state).output().unwrap();
    assert!(more.status.success(), "{}", said(&more));
    let whole = riprap(&folder, last, "whole").output().unwrap();
    assert!(whole.status.success(), "{}", said(&whole));
    assert_same_files(
        &folder,
        ["cut", "whole"],
        &["checkpoint.riprap", "history.csv"],
    );
}

/// `/dev/full` answers every write with ENOSPC, as a full disk does.
#[test]
fn a_disk_that_fills_up_ends_a_run_with_the_file_and_the_last_good_state() {
    let folder = folder("disk");
    let good = riprap(&folder, 60, "good").output().unwrap();
    assert!(good.status.success(), "{}", said(&good));
    let files = fs::read_dir(folder.join("good")).unwrap();
    let mut images: Vec<_> = files
        .map(|file| file.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.ends_with(".vti"))
        .collect();
    images.sort();
    let last = images.last().unwrap();
    fs::create_dir_all(folder.join("full")).unwrap();
    let draft = folder.join("full").join(format!("{last}.part"));
    std::os::unix::fs::symlink("/dev/full", draft).unwrap();
    let full = riprap(&folder, 60, "full").output().unwrap();
    let text = said(&full);
    assert_eq!(full.status.code(), Some(1), "{text}");
    let words = [
        last.as_str(),
        "No space left",
        "free some space",
        "checkpoint.riprap",
        "--restart",
    ];
    assert_contains(text, &words);
    // That state is complete, and with more space leads to the same end.
    let state = folder.join("full/checkpoint.riprap");
    let _ = fs::remove_file(folder.join("full").join(format!("{last}.part")));
    let mut more = riprap(&folder, 60, "full");
    let more = more.arg("--restart").arg(&state).output().unwrap();
    assert!(more.status.success(), "{}", said(&more));
    assert!(!said(&more).contains("another scene"), "{}", said(&more));
    assert_same_files(&folder, ["full", "good"], &["checkpoint.riprap", last]);
}

/// Lavapipe uses the memory of the process: 1.8 GB do not hold 216³ cells of 108 bytes and their initial state.
#[cfg(target_os = "linux")]
#[test]
fn a_run_without_memory_for_its_cells_says_how_much_they_take() {
    let info = gpu::selected().unwrap().get_info();
    if info.backend != wgpu::Backend::Vulkan || !info.name.contains("llvmpipe") {
        eprintln!(
            "{}: lavapipe alone has the memory that the process may have and refuses a buffer that exceeds it; OpenGL takes \
             the memory later, SwiftShader ends the process: nothing to test",
            gpu::describe(&info)
        );
        return;
    }
    let folder = folder("memory");
    let scene = "domain = { size = [216, 216, 216], cell = 1 }\nfluid = { density = 1, viscosity = 0.02 }\n\
                 numerics = { time_step = 1, velocity_scale = 0.06 }\nrun = { steps = 1 }\n";
    fs::write(folder.join("scene.toml"), scene).unwrap();
    let mut command = Command::new("sh");
    command.args(["-c", "ulimit -v 1800000 && exec \"$0\" \"$@\""]);
    command.arg(env!("CARGO_BIN_EXE_riprap")).arg("run");
    command
        .arg(folder.join("scene.toml"))
        .arg("--out")
        .arg(folder.join("out"));
    let output = command.output().unwrap();
    let text = said(&output);
    assert_eq!(output.status.code(), Some(2), "{text}");
    let words = [
        "10077696 cells",
        "1088391184 bytes",
        "memory",
        "larger cell or 16-bit",
    ];
    assert_contains(text, &words);
}
