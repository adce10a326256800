//! `riprap fingerprint` on two of its scenes: its output, that a second call gives the same, and its report if a record
//! differs.

use crate::fixture::folder;
use std::{
    fs,
    path::Path,
    process::{Command, Output},
};

fn fingerprint(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_riprap"))
        .args(["fingerprint", "--scenes", "scenes"])
        .args(args)
        .current_dir(folder)
        .output()
        .unwrap()
}

#[test]
fn two_calls_agree_and_a_changed_record_is_reported() {
    let folder = folder("fingerprint");
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fingerprints");
    fs::create_dir(folder.join("scenes")).unwrap();
    for name in ["dry_deformable.toml", "sph_plane.toml"] {
        fs::copy(shipped.join(name), folder.join("scenes").join(name)).unwrap();
    }
    let first = fingerprint(&folder, &["--json"]);
    let errors = String::from_utf8_lossy(&first.stderr);
    assert!(first.status.success(), "{errors}");
    let text = String::from_utf8(first.stdout).unwrap();
    let record: serde_json::Value = serde_json::from_str(&text).unwrap();
    for key in ["adapter", "backend", "driver", "date"] {
        assert!(record["machine"][key].is_string(), "{key}");
    }
    let sums = record["sums"].as_object().unwrap();
    assert!(sums.contains_key("dry_deformable/history.csv"), "{text}");
    let quantities = [
        "dry_deformable/blocks_000276.vtu:Points",
        "sph_plane/left.csv",
    ];
    assert!(
        quantities.iter().all(|key| sums.contains_key(*key)),
        "{text}"
    );
    let velocity = sums
        .keys()
        .find(|key| key.starts_with("sph_plane/water_") && key.ends_with(":velocity"));
    let velocity = velocity.unwrap().clone();
    let skipped = ["json", "png", "riprap"];
    for key in sums.keys() {
        let extension = Path::new(key).extension().unwrap().to_str().unwrap();
        assert!(!skipped.contains(&extension), "{key}");
    }

    fs::write(folder.join("record.json"), &text).unwrap();
    let second = fingerprint(&folder, &["--compare", "record.json"]);
    let errors = String::from_utf8_lossy(&second.stderr);
    assert_eq!(second.status.code(), Some(0), "{errors}");
    let lines = String::from_utf8(second.stdout).unwrap();
    assert!(lines.starts_with("# "), "{lines}");
    assert_eq!(lines.lines().count(), 1 + sums.len(), "{lines}");
    let sum = sums[&velocity].as_str().unwrap();
    assert!(lines.contains(&format!("\n{velocity} {sum}\n")));

    fs::remove_file(folder.join("scenes/sph_plane.toml")).unwrap();
    let bar = sums["dry_deformable/bar.csv"].as_str().unwrap();
    fs::write(folder.join("record.json"), text.replace(bar, "0-0")).unwrap();
    let third = fingerprint(&folder, &["--compare", "record.json"]);
    assert_eq!(third.status.code(), Some(1));
    let errors = String::from_utf8_lossy(&third.stderr);
    let changed = format!("dry_deformable/bar.csv: 0-0 -> {bar}\n");
    assert!(errors.contains(&changed), "{errors}");
    let absent = format!("{velocity}: {sum} -> absent\n");
    assert!(errors.contains(&absent), "{errors}");
    fs::remove_dir_all(folder).unwrap();
}
