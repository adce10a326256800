//! The documents: links resolve, scenes in them parse, and the paths they name exist.

use riprap::scene::Scene;
use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Every document, as a path from the root.
fn documents() -> Vec<PathBuf> {
    let mut documents: Vec<PathBuf> = [
        "README.md",
        "ARCHITECTURE.md",
        "CONTRIBUTING.md",
        "CHANGELOG.md",
        "kernels/SLOTS.md",
    ]
    .map(PathBuf::from)
    .into();
    let mut folders = vec![PathBuf::from("docs/src")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(root().join(&folder)).unwrap() {
            let entry = entry.unwrap();
            let path = folder.join(entry.file_name());
            if entry.file_type().unwrap().is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "md") {
                documents.push(path);
            }
        }
    }
    assert!(documents.len() > 15, "{documents:?}");
    documents
}

fn read(document: &Path) -> String {
    let path = root().join(document);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", document.display()))
}

/// A part of a document: its lines outside of fenced code, or one fenced block with the language of its fence.
struct Parts {
    prose: Vec<(usize, String)>,
    /// Line of the fence, language, text.
    blocks: Vec<(usize, String, String)>,
}

fn parts(text: &str) -> Parts {
    let mut parts = Parts {
        prose: Vec::new(),
        blocks: Vec::new(),
    };
    let mut open = false;
    for (number, line) in (1..).zip(text.lines()) {
        if let Some(language) = line.trim_start().strip_prefix("```") {
            open = !open;
            if open {
                parts.blocks.push((number, language.into(), String::new()));
            }
        } else if open {
            let (_, _, block) = parts.blocks.last_mut().unwrap();
            block.push_str(line);
            block.push('\n');
        } else {
            parts.prose.push((number, line.into()));
        }
    }
    assert!(!open, "a fence stays open");
    parts
}

/// Text without code spans.
fn without_code(line: &str) -> String {
    line.split('`').step_by(2).collect::<Vec<_>>().join("`")
}

/// The targets of the links and images of a line.
fn targets(line: &str) -> Vec<String> {
    let line = without_code(line);
    line.split("](")
        .skip(1)
        .filter_map(|rest| Some(rest.split_once(')')?.0.to_owned()))
        .collect()
}

/// The anchors of a document, as GitHub and mdBook derive them from its headings.
fn anchors(text: &str) -> BTreeSet<String> {
    let mut anchors = BTreeSet::new();
    for (_, line) in parts(text).prose {
        let heading = line.trim_start_matches('#');
        if heading.len() < line.len() && heading.starts_with(' ') {
            let kept = heading.trim().to_lowercase();
            let kept = kept.chars().filter_map(|c| match c {
                ' ' => Some('-'),
                '-' | '_' => Some(c),
                _ => c.is_alphanumeric().then_some(c),
            });
            let anchor: String = kept.collect();
            assert!(anchors.insert(anchor), "two headings are called{heading}");
        }
    }
    anchors
}

#[test]
fn relative_links_and_anchors_resolve() {
    let mut broken = Vec::new();
    let mut count = 0;
    for document in documents() {
        let text = read(&document);
        for (line, prose) in parts(&text).prose {
            for target in targets(&prose) {
                if target.contains("://") {
                    continue;
                }
                count += 1;
                let (file, anchor) = target.split_once('#').unwrap_or((target.as_str(), ""));
                let path = match file {
                    "" => document.clone(),
                    _ => document.parent().unwrap().join(file),
                };
                let found = root().join(&path).exists()
                    && (anchor.is_empty() || anchors(&read(&path)).contains(anchor));
                if !found {
                    broken.push(format!("{}:{line}: {target}", document.display()));
                }
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
    assert!(count > 50, "{count}");
}

#[test]
fn every_chapter_is_in_the_summary() {
    let summary = parts(&read(Path::new("docs/src/SUMMARY.md")));
    let listed = summary.prose.iter().flat_map(|(_, line)| targets(line));
    let listed: BTreeSet<PathBuf> = listed
        .map(|file| Path::new("docs/src").join(file))
        .collect();
    let chapters: BTreeSet<PathBuf> = documents()
        .into_iter()
        .filter(|path| path.starts_with("docs") && !path.ends_with("SUMMARY.md"))
        .collect();
    assert_eq!(listed, chapters);
}

#[test]
fn scenes_in_documents_parse() {
    let mut count = 0;
    for document in documents() {
        for (line, language, block) in parts(&read(&document)).blocks {
            if language == "toml" {
                count += 1;
                if let Err(error) = Scene::from_toml(&block, &root(), "scene") {
                    panic!("{}:{line}: {error}", document.display());
                }
            }
        }
    }
    assert!(count >= 4, "{count}");
}

#[test]
fn paths_in_documents_exist() {
    const FOLDERS: [&str; 7] = [
        "src/", "kernels/", "harness/", "tests/", "benches/", "docs/", ".ci/",
    ];
    let mut missing = Vec::new();
    let mut count = 0;
    for document in ["ARCHITECTURE.md", "CONTRIBUTING.md", "kernels/SLOTS.md"] {
        for (line, prose) in parts(&read(Path::new(document))).prose {
            for code in prose.split('`').skip(1).step_by(2) {
                // Names such as `harness/results/*.json` and `NAME` stand for many files.
                let many = code.contains(['*', ' ', '<']) || code.contains("NAME");
                if many || !FOLDERS.iter().any(|folder| code.starts_with(folder)) {
                    continue;
                }
                count += 1;
                if !root().join(code).exists() {
                    missing.push(format!("{document}:{line}: {code}"));
                }
            }
        }
    }
    assert!(missing.is_empty(), "{}", missing.join("\n"));
    assert!(count > 60, "{count}");
}
