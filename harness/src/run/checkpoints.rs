//! The state from which a run can go on: `checkpoint.riprap`, and the scene that it is of beside it, `checkpoint.toml`.

use super::{
    recorder::{Recorder, RunLog, Schedule},
    scene_run::SceneRun,
};
use anyhow::Result;
use std::{
    fs,
    path::{Path, PathBuf},
    time::Instant,
};
use toml::{Table, Value};

/// Parts of a run after each of which it has a checkpoint, where the scene does not say when.
const PARTS: f64 = 10.0;
/// The same within the first of them: much of what diverges does so soon.
const EARLY: f64 = 100.0;
/// Fewest parts: the last good state should not be the start.
const FEWEST: f64 = 2.0;
/// Bytes that more than these may have together, half a minute of a slow disk: larger states come less often.
const BYTES: f64 = 4e9;
/// Part of the time of a run that writing states of more than [`SMALL`] may take.
const SHARE: f64 = 0.05;
/// Bytes of a state that is written at once.
const SMALL: u64 = 4_000_000;

pub struct Checkpoints {
    schedule: Schedule,
    /// The run, where it is ours to choose its parts.
    own: Option<Parted>,
    /// Step of the previous checkpoint, or of the start, and the time at its end.
    previous: (u64, Instant),
    path: PathBuf,
    /// The scene's file.
    text: String,
}

impl Checkpoints {
    pub fn new(run: &SceneRun, folder: &Path, last: u64, text: &str) -> Self {
        let (requested, time_step) = (run.scene().run.checkpoint_every, run.time_step());
        let parted = Parted { time_step, last };
        Self {
            schedule: match requested {
                Some(every) => Schedule::new(Some(every), time_step, last),
                None => parted.schedule(run.step(), 0, 0.0),
            },
            previous: (run.step(), Instant::now()),
            own: requested.is_none().then_some(parted),
            path: folder.join("checkpoint.riprap"),
            text: text.to_owned(),
        }
    }
}

/// A run in equal parts.
struct Parted {
    /// s
    time_step: f64,
    last: u64,
}

impl Parted {
    /// When checkpoints of so many bytes are due after `step`; each takes as long as that many `steps`.
    fn schedule(&self, step: u64, bytes: u64, steps: f64) -> Schedule {
        let parts = (BYTES / bytes.max(1) as f64).clamp(FEWEST, PARTS).floor();
        let early = parts == PARTS && (step as f64) < self.last as f64 / PARTS;
        let part = self.last as f64 / if early { EARLY } else { parts };
        let long = if bytes > SMALL { steps / SHARE } else { 0.0 };
        let every = part.max(long.min(self.last as f64));
        Schedule::new(Some(every * self.time_step), self.time_step, self.last)
    }
}

impl Recorder for Checkpoints {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn record(&mut self, run: &mut SceneRun, log: &mut RunLog) -> Result<()> {
        let step = run.step();
        if step == 0 {
            return Ok(());
        }
        let begin = Instant::now();
        let written = run.checkpoint(&self.path).map_err(Into::into);
        match written.and_then(|()| keep_scene(&self.text, &self.path)) {
            // The scene does not request it, and the run goes on without.
            Err(error) if self.own.is_some() => {
                const FAILED: &str = "no checkpoint at step";
                // A full disk stays full: one warning is enough.
                if !log.warnings.iter().any(|known| known.starts_with(FAILED)) {
                    log.warnings.push(format!("{FAILED} {step}: {error:#}"));
                }
                return Ok(());
            }
            done => done?,
        }
        log.checkpoint = Some((step, self.path.clone()));
        log.file(self.path.clone());
        if let (Some(run), Ok(file)) = (&self.own, self.path.metadata()) {
            let (before, end) = self.previous;
            let pace = (step - before) as f64 / (begin - end).as_secs_f64().max(1e-9);
            let steps = pace * begin.elapsed().as_secs_f64();
            self.schedule = run.schedule(step, file.len(), steps);
            self.previous = (step, Instant::now());
        }
        Ok(())
    }
}

/// What may differ without the flow being another: what is written, and for how long.
const BESIDE: [&str; 5] = ["title", "run", "output", "probes", "views"];
/// Differences that are named before the rest is counted.
const NAMED: usize = 5;

/// Where the scene of the checkpoint at `path` is.
fn beside(path: &Path) -> PathBuf {
    path.with_extension("toml")
}

/// Keeps the `text` of the scene that the checkpoint at `path` is of.
fn keep_scene(text: &str, path: &Path) -> Result<()> {
    let path = beside(path);
    if fs::read_to_string(&path).is_ok_and(|kept| kept == text) {
        return Ok(());
    }
    riprap::output::replace(&path, |file| file.write_all(text.as_bytes()))?;
    Ok(())
}

/// A warning where the scene `text` is another than that of the checkpoint at `path`: which of its values differ. None
/// where that is not known, because there is no scene beside the checkpoint.
pub fn other_scene(path: &Path, text: &str) -> Option<String> {
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

    /// The steps at which a run of 200 has checkpoints of so many bytes, which take as long as so many steps.
    fn due(bytes: u64, steps: f64) -> Vec<u64> {
        let run = Parted {
            time_step: 0.1,
            last: 200,
        };
        let mut schedule = run.schedule(0, 0, 0.0);
        let mut due = vec![schedule.next(0)];
        while *due.last().unwrap() < 200 {
            let step = *due.last().unwrap();
            schedule = run.schedule(step, bytes, steps);
            due.push(schedule.next(step));
        }
        due
    }

    #[test]
    fn early_states_are_kept_and_large_ones_are_written_less_often() {
        let tenths = (2..=10).map(|part| 20 * part);
        let small: Vec<u64> = (1..=10).map(|part| 2 * part).chain(tenths).collect();
        assert_eq!(due(400_000_000, 0.1), small);
        assert_eq!(due(1_000_000_000, 0.1), [2, 50, 100, 150, 200]);
        assert_eq!(due(1 << 40, 0.1), [2, 100, 200]);
    }

    #[test]
    fn what_takes_long_to_write_is_written_less_often() {
        assert_eq!(due(400_000_000, 3.0), [2, 60, 120, 180, 200]);
        assert_eq!(due(400_000_000, 30.0), [2, 200]);
        assert_eq!(due(400_000, 30.0), due(400_000, 0.0));
    }

    fn found(before: &str, now: &str) -> String {
        let folder = std::env::temp_dir().join(format!("riprap_origin_{}", std::process::id()));
        fs::create_dir_all(&folder).expect("a folder to write to");
        let path = folder.join("checkpoint.riprap");
        keep_scene(before, &path).expect("a folder to write to");
        let warning = other_scene(&path, now);
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
