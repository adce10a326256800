//! Checkpoints, from which a run can be restarted: `checkpoint.riprap`, and a copy of its scene, `checkpoint.toml`.

use super::{
    extremes,
    recorder::{Recorder, RunLog, Schedule},
    scene_run::SceneRun,
};
use anyhow::Result;
use riprap::Error;
use std::{
    fs,
    path::{Path, PathBuf, absolute},
    time::Instant,
};
use toml::{Table, Value};

/// Number of equal parts of a run after each of which a checkpoint is written, unless the scene gives an interval.
const PARTS: f64 = 10.0;
/// The same within the first part: runs that diverge often do so early.
const EARLY: f64 = 100.0;
/// Smallest number of parts, so that the last good state is not the start.
const FEWEST: f64 = 2.0;
/// Largest total of bytes of more than [`FEWEST`] checkpoints, half a minute of a slow disk: larger states come less often.
const BYTES: f64 = 4e9;
/// Fraction of the run time that writing states of more than [`SMALL`] bytes may take.
const SHARE: f64 = 0.05;
/// Bytes of a state that takes no noticeable time to write.
const SMALL: u64 = 4_000_000;

pub struct Checkpoints {
    schedule: Schedule,
    /// The run, if the scene gives no interval of checkpoints.
    own: Option<Parted>,
    /// Step of the previous checkpoint or of the start, and the time when it was done.
    previous: (u64, Instant),
    path: PathBuf,
    /// Text of the scene file.
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
    /// Schedule of checkpoints of `bytes` bytes after `step`; writing one takes as long as `steps` steps.
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
        if let Some(rock) = run.rock() {
            log.block_speed = log.block_speed.max(rock.blocks.peak_speed());
        }
        let written = run.checkpoint(&self.path).map_err(Into::into);
        let written = written.and_then(|()| extremes::keep(&self.path, step, log));
        match written.and_then(|()| keep_scene(&self.text, &self.path)) {
            // The scene did not request this checkpoint, so the run goes on without it.
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

/// Sections that may differ without changing the flow: what is written, and for how long the run lasts.
const BESIDE: [&str; 5] = ["title", "run", "output", "probes", "views"];
/// Number of differences that are named; the rest is counted.
const NAMED: usize = 5;

/// Path of the scene of the checkpoint at `path`.
fn beside(path: &Path) -> PathBuf {
    path.with_extension("toml")
}

/// Keeps the `text` of the scene next to its checkpoint at `path`.
fn keep_scene(text: &str, path: &Path) -> Result<()> {
    let path = beside(path);
    if fs::read_to_string(&path).is_ok_and(|kept| kept == text) {
        return Ok(());
    }
    riprap::output::replace(&path, |file| file.write_all(text.as_bytes()))?;
    Ok(())
}

/// Checks that the blocks of the scene `text` have the order of those of the checkpoint at `path`, by which they get their states.
pub fn check_order(path: &Path, text: &str) -> Result<()> {
    let blocks = |text: &str| -> Vec<String> {
        let table = text.parse::<Table>().unwrap_or_default();
        let blocks = table.get("blocks").and_then(Value::as_array);
        let name = |block: &Value| block.get("name").and_then(Value::as_str).map(String::from);
        let names = blocks.into_iter().flatten().map(name);
        names.map(Option::unwrap_or_default).collect()
    };
    let before = blocks(&fs::read_to_string(beside(path)).unwrap_or_default());
    for (number, name) in blocks(text)
        .iter()
        .enumerate()
        .filter(|(_, name)| !name.is_empty())
    {
        let place = before.iter().position(|other| other == name);
        if let Some(place) = place.filter(|place| *place != number) {
            anyhow::bail!(
                "blocks[{number}] is {name}, which was blocks[{place}] when {} was written, and states go to the blocks by \
                 their order; restore the order",
                path.display()
            );
        }
    }
    Ok(())
}

/// A warning if the scene `text` differs from that of the checkpoint at `path`, with the values that differ. `None` if
/// there is no scene next to the checkpoint.
pub fn other_scene(path: &Path, text: &str) -> Option<String> {
    let path = beside(path);
    let found = named_differences(&path, text)?;
    Some(format!(
        "the checkpoint is of another scene, which {} keeps: {found}; the run continues with the present scene, and \
         energy_error includes the change",
        path.display()
    ))
}

/// The `error` of restoring the checkpoint at `path`, after the values in which the scene `text` differs from that of the
/// checkpoint.
pub fn with_differences(error: Error, path: &Path, text: &str) -> anyhow::Error {
    let error = anyhow::Error::new(error);
    match named_differences(&beside(path), text) {
        Some(found) => error.context(format!("since the checkpoint, {found}")),
        None => error,
    }
}

/// A warning if `folder` holds the output of another scene than `text` and the checkpoint at `path` lies elsewhere: the rows of
/// its tables up to the step of the checkpoint stay.
pub fn other_tables(path: &Path, folder: &Path, text: &str) -> Option<String> {
    let [path, own] = [path, folder].map(|path| absolute(path).ok());
    if path?.parent() == own.as_deref() {
        return None;
    }
    let found = named_differences(&folder.join("checkpoint.toml"), text)?;
    Some(format!(
        "{} holds the output of another scene: {found}; rows of its tables before the step of the checkpoint stay; \
         for new tables choose another folder with `--out`",
        folder.display()
    ))
}

/// The values in which the scene `text` differs from the one at `path`, the first of them by name. `None` if no value
/// differs or there is no scene.
fn named_differences(path: &Path, text: &str) -> Option<String> {
    let table = |text: &str| text.parse::<Table>().ok();
    let [mut before, mut now] = [table(&fs::read_to_string(path).ok()?)?, table(text)?];
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
    (!found.is_empty()).then(|| found.join(", ") + &rest)
}

/// Adds to `found` the differences between `before` and `now`, the values of a scene at `key`.
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

/// The value as a number: `1` and `1.0` are equal.
fn number(value: &Value) -> Option<f64> {
    value.as_float().or(value.as_integer().map(|n| n as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The steps at which a run of 200 steps writes checkpoints of `bytes` bytes, each of which takes as long as `steps` steps.
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

    #[test]
    fn blocks_in_another_order_are_refused() {
        let order =
            |now: &str| with_checkpoint_of(&two_blocks("b", "c"), |path| check_order(path, now));
        let refused = order(&two_blocks("c", "b")).unwrap_err().to_string();
        assert!(
            refused.starts_with("blocks[0] is c, which was blocks[1]"),
            "{refused}"
        );
        assert!(order(&two_blocks("b", "d")).is_ok());
    }

    fn two_blocks(first: &str, second: &str) -> String {
        format!("[[blocks]]\nname = '{first}'\n[[blocks]]\nname = '{second}'\n")
    }

    /// The result of `compare` with a checkpoint of the scene `before`.
    fn with_checkpoint_of<T>(before: &str, compare: impl Fn(&Path) -> T) -> T {
        let folder = tempfile::tempdir().expect("a folder to write to");
        let path = folder.path().join("checkpoint.riprap");
        keep_scene(before, &path).expect("a folder to write to");
        compare(&path)
    }

    fn found(before: &str, now: &str) -> String {
        with_checkpoint_of(before, |path| other_scene(path, now).unwrap_or_default())
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

    #[test]
    fn tables_of_another_scene_are_warned_of_except_next_to_the_checkpoint() {
        let [before, now] = [1, 2].map(|density| format!("[fluid]\ndensity = {density}\n"));
        let other = tempfile::tempdir().expect("a folder to write to");
        with_checkpoint_of(&now, |path| {
            let folder = path.parent().expect("a folder");
            assert_eq!(other_tables(path, folder, &before), None);
            assert_eq!(other_tables(path, other.path(), &now), None);
            keep_scene(&before, &other.path().join("checkpoint.riprap")).expect("a folder");
            let warning = other_tables(path, other.path(), &now).unwrap_or_default();
            let named = "holds the output of another scene: fluid.density was 1 and is 2;";
            assert!(warning.contains(named), "{warning}");
        });
    }

    #[test]
    fn a_state_that_is_refused_comes_with_what_differs() {
        with_checkpoint_of("a = 1\n", |path| {
            let refused = |text: &str| {
                with_differences(
                    Error::argument("restart", "is of another scene"),
                    path,
                    text,
                )
            };
            let message = format!("{:#}", refused("a = 2\n"));
            let named = "since the checkpoint, a was 1 and is 2: ";
            assert!(message.starts_with(named), "{message}");
            assert!(message.ends_with("is of another scene"), "{message}");
            assert_eq!(refused("a = 1\n").chain().count(), 1);
        });
    }
}
