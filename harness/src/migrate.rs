//! `riprap migrate`: rewrites the old keys of a scene.

use clap::Args as ClapArgs;
use riprap::{Error, output::replace, scene};
use std::path::PathBuf;

/// Rewrite a scene whose keys have an old name.
///
/// Prints each key that changes. Everything else in the file stays as it is, comments included. With --check the exit
/// code is 1 if there are old keys.
#[derive(ClapArgs, Debug)]
pub struct Args {
    /// TOML file of the scene.
    scene: PathBuf,
    /// Report the old keys, and leave the file as it is.
    #[arg(long)]
    check: bool,
}

/// Rewrites the file. Returns `false` only if `--check` finds old keys.
pub fn run(args: &Args) -> anyhow::Result<bool> {
    let path = args.scene.display().to_string();
    let text = std::fs::read_to_string(&args.scene)
        .map_err(|error| Error::file(&args.scene, error.to_string()))?;
    let (migrated, renamed) = scene::migrate(&text, &path)?;
    for renaming in &renamed {
        println!("{path}:{}:{}: {renaming}", renaming.line, renaming.column);
    }
    if renamed.is_empty() {
        println!("{path}: no old keys");
    } else if !args.check {
        replace(&args.scene, |file| file.write_all(migrated.as_bytes()))?;
    }
    Ok(!args.check || renamed.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn check_leaves_the_file_and_a_second_run_finds_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let scene = folder.path().join("scene.toml");
        let old = "[rock]\nsearch = \"host\" # few blocks\n";
        std::fs::write(&scene, old).unwrap();
        let args = |check| Args {
            scene: scene.clone(),
            check,
        };
        let read = || std::fs::read_to_string(&scene).unwrap();
        assert!(!run(&args(true)).unwrap());
        assert_eq!(read(), old);
        assert!(run(&args(false)).unwrap());
        assert_eq!(read(), old.replace("search", "broadphase"));
        assert!(run(&args(true)).unwrap());
    }
}
