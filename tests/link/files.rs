//! The files themselves.

use riprap::link::{SOURCES, needs};
use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
};

fn kernels_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("kernels")
}

#[test]
fn every_file_is_a_source_and_the_reverse() {
    let mut files = BTreeSet::new();
    for folder in std::fs::read_dir(kernels_folder()).unwrap() {
        for file in std::fs::read_dir(folder.unwrap().path()).unwrap() {
            let path = file.unwrap().path();
            assert_eq!(path.extension().unwrap(), "wgsl", "{}", path.display());
            files.insert(path.file_stem().unwrap().to_str().unwrap().to_owned());
        }
    }
    let sources: BTreeSet<_> = SOURCES.iter().map(|(name, _)| (*name).to_owned()).collect();
    assert_eq!(files, sources);
    assert_eq!(sources.len(), SOURCES.len(), "a name occurs twice");
}

#[test]
fn files_stand_on_files_that_exist() {
    // Their texts depend on the setup.
    let generated = ["populations", "scalars", "workgroup"];
    for (name, text) in SOURCES {
        for (line, needed) in needs(text) {
            let known = needed.starts_with('$')
                || generated.contains(&needed)
                || riprap::link::source(needed).is_some();
            assert!(known, "{name}:{line}: {needed}");
        }
    }
}

/// A file begins with what it is; one with an entry point with the author and year of its formula,
/// unless it only copies.
#[test]
fn first_lines_say_what_a_file_is() {
    let year = |word: &str| {
        let digits: String = word.chars().filter(char::is_ascii_digit).collect();
        digits.len() == 4 && (1800..2100).contains(&digits.parse::<u32>().unwrap_or(0))
    };
    for (name, text) in SOURCES {
        let first = text.lines().next().unwrap_or_default();
        let said = first.strip_prefix("// ").unwrap_or_default();
        let cited = said.split_whitespace().any(year);
        assert!(
            cited || said.starts_with(char::is_uppercase),
            "{name}: {first}"
        );
        let copies = ["gather"].contains(name);
        assert!(
            cited || copies || !text.contains("@compute"),
            "{name}: {first}"
        );
    }
}
