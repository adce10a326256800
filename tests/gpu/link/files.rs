//! The kernel files themselves.

use riprap::gpu::link::{SOURCES, needs};
use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
};

fn kernels_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../kernels")
}

#[test]
fn every_file_is_a_source_and_the_reverse() {
    let mut files = BTreeSet::new();
    for folder in std::fs::read_dir(kernels_folder()).unwrap() {
        let folder = folder.unwrap().path();
        if folder.ends_with("SLOTS.md") {
            continue;
        }
        for file in std::fs::read_dir(folder).unwrap() {
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
    // Their text depends on the setup.
    let generated = [
        "populations",
        "scalars",
        "velocities",
        "cell_velocities",
        "forces",
        "statistics_planes",
        "psm_storage",
        "psm_storage_written",
        "workgroup",
    ];
    for (name, text) in SOURCES {
        for (line, needed) in needs(text) {
            let known = needed.starts_with('$')
                || generated.contains(&needed)
                || riprap::gpu::link::source(needed).is_some();
            assert!(known, "{name}:{line}: {needed}");
        }
    }
}

/// A file begins with a statement of its content; files with an entry point begin with author and year of the method, unless
/// they only copy.
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

/// Names in the code spans of a table cell, up to the end of the identifier.
fn names(cell: &str) -> Vec<&str> {
    let spans = cell.split('`').skip(1).step_by(2);
    spans
        .map(|span| {
            let end = span.find(|c: char| !c.is_alphanumeric() && c != '_' && c != '$');
            &span[..end.unwrap_or(span.len())]
        })
        .collect()
}

#[test]
fn the_table_of_slots_lists_each_slot_with_its_files_and_functions() {
    let table = std::fs::read_to_string(kernels_folder().join("SLOTS.md")).unwrap();
    let mut listed = BTreeSet::new();
    for row in table.lines().filter(|line| line.starts_with("| `$")) {
        let cells: Vec<_> = row.split('|').map(str::trim).collect();
        let [_, slot, files, functions, _, _] = cells[..] else {
            panic!("{row}");
        };
        let slot = names(slot)[0];
        assert!(listed.insert(slot.to_owned()), "{slot} has two rows");
        for file in names(files) {
            let text = riprap::gpu::link::source(file).unwrap_or_else(|| panic!("{slot}: {file}"));
            for function in names(functions) {
                // Types begin with a capital letter.
                let defined = text.contains(&format!("fn {function}("));
                assert!(
                    defined || function.starts_with(char::is_uppercase),
                    "{slot}: {file} lacks {function}"
                );
            }
        }
    }
    let all = SOURCES.iter().flat_map(|(_, text)| needs(text));
    let all = all.map(|(_, needed)| needed.to_owned());
    let slots: BTreeSet<_> = all.filter(|needed| needed.starts_with('$')).collect();
    assert_eq!(listed, slots);
}

/// A constant that a caller forgets must cause an error, not take a plausible default.
#[test]
fn no_constant_has_a_default() {
    for (name, text) in SOURCES {
        let mut overrides = text.lines().filter(|line| line.starts_with("override "));
        assert!(overrides.all(|line| !line.contains('=')), "{name}");
    }
}
