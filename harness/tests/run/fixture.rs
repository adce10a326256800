//! What tests of `riprap run` share: a folder of their own, and a scene in it.

use riprap_harness::run::{Args, Summary, run};
use std::{
    fs,
    path::{Path, PathBuf},
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
    fs::write(&scene, text).unwrap();
    Args {
        scene,
        out: Some(folder.join(out)),
        ..Args::default()
    }
}

/// The whole run.
pub fn go(args: &Args) -> Summary {
    run(args, &AtomicBool::new(false)).unwrap()
}
