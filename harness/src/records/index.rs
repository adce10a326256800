//! The records of a machine, and the commit of each.

use crate::bench::Machine;
use anyhow::Context;
use riprap::output::replace;
use serde::{Deserialize, Serialize};
use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

/// How a record ended.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// All limits are met.
    Passed,
    /// A limit is missed.
    Missed,
    /// The command did not complete.
    BrokeOff,
}

/// A record.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Entry {
    /// How it ended.
    pub verdict: Verdict,
    /// Commit from which it was made.
    pub commit: String,
    /// Date and time, UTC.
    pub date: String,
    /// Whether it is in the long form.
    pub full: bool,
    /// Duration, s.
    pub seconds: f64,
}

/// The records of a machine: `index.json` in their folder.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
pub struct Index {
    /// Adapter, driver and cores.
    pub machine: String,
    /// The records by name.
    pub entries: BTreeMap<String, Entry>,
    /// Folder of the index.
    #[serde(skip)]
    pub folder: PathBuf,
}

const FILE: &str = "index.json";

impl Index {
    /// The index in `folder`, empty if there is none.
    pub fn read(folder: &Path) -> anyhow::Result<Self> {
        let path = folder.join(FILE);
        let mut index = if path.exists() {
            let text = fs::read_to_string(&path);
            let text = text.with_context(|| format!("cannot read {}", path.display()))?;
            serde_json::from_str(&text)
                .with_context(|| format!("{} is no index of records", path.display()))?
        } else {
            Self::default()
        };
        index.folder = folder.into();
        Ok(index)
    }

    /// The indices of all machines in `records`, by folder name.
    pub fn all(records: &Path) -> anyhow::Result<Vec<Self>> {
        let found = fs::read_dir(records)
            .with_context(|| format!("there are no records in {}", records.display()))?;
        let mut folders: Vec<_> = found
            .filter_map(|entry| entry.ok().map(|entry| entry.path()))
            .filter(|path| path.join(FILE).exists())
            .collect();
        folders.sort();
        folders.iter().map(|folder| Self::read(folder)).collect()
    }

    /// Whether there is a record `name` of `commit`, in the long form if `full`.
    pub fn has(&self, name: &str, commit: &str, full: bool) -> bool {
        self.entries.get(name).is_some_and(|entry| {
            entry.commit == commit && entry.verdict != Verdict::BrokeOff && (entry.full || !full)
        })
    }

    /// Writes the index to `folder`.
    pub fn write(&mut self, folder: &Path, machine: &Machine) -> anyhow::Result<()> {
        self.machine = format!(
            "{}, {}, {} cores",
            machine.adapter, machine.driver, machine.cores
        );
        let text = serde_json::to_string_pretty(self)? + "\n";
        Ok(replace(&folder.join(FILE), |file| {
            file.write_all(text.as_bytes())
        })?)
    }

    /// The rows of the record `name`; empty if there is no such file.
    pub fn rows<T: serde::de::DeserializeOwned>(&self, name: &str) -> anyhow::Result<Vec<T>> {
        let path = self.folder.join(format!("{name}.json"));
        if !path.exists() {
            return Ok(Vec::new());
        }
        let text = fs::read_to_string(&path);
        let text = text.with_context(|| format!("cannot read {}", path.display()))?;
        serde_json::from_str(&text).with_context(|| format!("{} is no record", path.display()))
    }
}
