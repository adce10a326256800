//! The scene that a checkpoint is of, kept beside it: `checkpoint.toml`.

use anyhow::Result;
use std::{
    fs,
    path::{Path, PathBuf},
};
use toml::{Table, Value};

/// What may differ without the flow being another: what is written, and for how long.
const BESIDE: [&str; 5] = ["title", "run", "output", "probes", "views"];
/// Differences that are named before the rest is counted.
const NAMED: usize = 5;

/// Where the scene of the checkpoint at `path` is.
fn beside(path: &Path) -> PathBuf {
    path.with_extension("toml")
}

/// Keeps the `text` of the scene that the checkpoint at `path` is of.
pub fn keep(text: &str, path: &Path) -> Result<()> {
    let path = beside(path);
    if fs::read_to_string(&path).is_ok_and(|kept| kept == text) {
        return Ok(());
    }
    riprap::output::replace(&path, |file| file.write_all(text.as_bytes()))?;
    Ok(())
}

/// A warning where the scene `text` is another than that of the checkpoint at `path`: which of its values differ. None
/// where that is not known, because there is no scene beside the checkpoint.
pub fn warning(path: &Path, text: &str) -> Option<String> {
    let path = beside(path);
    let table = |text: &str| text.parse::<Table>().ok();
    let [mut before, mut now] = [table(&fs::read_to_string(&path).ok()?)?, table(text)?];
    for key in BESIDE {
        before.remove(key);
        now.remove(key);
    }
    let mut found = Vec::new();
    differences("", &before.into(), &now.into(), &mut found);
    let more = found.len().saturating_sub(NAMED);
    found.truncate(NAMED);
    let rest = match more {
        0 => String::new(),
        _ => format!(", and {more} more"),
    };
    (!found.is_empty()).then(|| {
        format!(
            "the checkpoint is of another scene, which {} keeps: {}{rest}; the run goes on with what the scene says now",
            path.display(),
            found.join(", ")
        )
    })
}

/// Adds to `found` what `now` has else than `before`, at the `key` of the scene.
fn differences(key: &str, before: &Value, now: &Value, found: &mut Vec<String>) {
    match (before, now) {
        (Value::Table(before), Value::Table(now)) => {
            let mut keys: Vec<_> = before.keys().chain(now.keys()).collect();
            keys.sort();
            keys.dedup();
            for name in keys {
                let inner = match key {
                    "" => name.clone(),
                    _ => format!("{key}.{name}"),
                };
                match (before.get(name), now.get(name)) {
                    (Some(before), Some(now)) => differences(&inner, before, now, found),
                    (Some(_), None) => found.push(format!("{inner} is gone")),
                    _ => found.push(format!("{inner} is new")),
                }
            }
        }
        (Value::Array(before), Value::Array(now)) if before.len() == now.len() => {
            for (number, (before, now)) in before.iter().zip(now).enumerate() {
                differences(&format!("{key}[{number}]"), before, now, found);
            }
        }
        (Value::Array(before), Value::Array(now)) => found.push(format!(
            "{key} had {} entries and has {}",
            before.len(),
            now.len()
        )),
        _ if number(before).is_some() && number(before) == number(now) => {}
        _ if before == now => {}
        _ => found.push(format!("{key} was {before} and is {now}")),
    }
}

/// `1` and `1.0` are one number.
fn number(value: &Value) -> Option<f64> {
    value.as_float().or(value.as_integer().map(|n| n as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(before: &str, now: &str) -> String {
        let folder = std::env::temp_dir().join(format!("riprap_origin_{}", std::process::id()));
        fs::create_dir_all(&folder).expect("a folder to write to");
        let path = folder.join("checkpoint.riprap");
        keep(before, &path).expect("a folder to write to");
        let warning = warning(&path, now);
        fs::remove_dir_all(&folder).expect("the folder");
        warning.unwrap_or_default()
    }

    #[test]
    fn what_differs_is_named_and_what_is_only_written_is_not() {
        let before = "title = 'a'\n[fluid]\nviscosity = 1e-3\ndensity = 1000\n[[blocks]]\nname = 'b'\n\
                      position = [0, 0, 1]\n[run]\nduration = 1\n";
        assert_eq!(found(before, before), "");
        let longer = before.replace("duration = 1", "duration = 9") + "[output]\npictures = []\n";
        assert_eq!(found(before, &longer.replace("= 1000", "= 1000.0")), "");
        let thicker = found(before, &before.replace("1e-3", "2e-3"));
        assert!(
            thicker.contains("fluid.viscosity was 0.001 and is 0.002;"),
            "{thicker}"
        );
        let higher = found(before, &before.replace("0, 1]", "0, 2.0]"));
        assert!(
            higher.contains("blocks[0].position[2] was 1 and is 2"),
            "{higher}"
        );
        let two = found(before, &(before.to_owned() + "[[blocks]]\nname = 'c'\n"));
        assert!(two.contains("blocks had 1 entries and has 2"), "{two}");
        let gone = found(before, &before.replace("density = 1000\n", ""));
        assert!(gone.contains("fluid.density is gone"), "{gone}");
    }
}
