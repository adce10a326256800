//! `riprap fingerprint`: checksums of the output of small scenes, to check that a change of the code leaves it bitwise equal.
//!
//! Each array of a VTK file has a checksum of its own, and each table one of its text. Summaries, pictures and
//! checkpoints are skipped: they hold times, fonts and formats that may change while results do not.

use crate::{bench::Machine, gpu, print, run};
use anyhow::{Context, Result, bail};
use riprap::Error;
use serde::{Deserialize, Serialize};
use std::{
    collections::{BTreeMap, BTreeSet},
    fmt::Write,
    fs,
    path::{Path, PathBuf},
    sync::atomic::AtomicBool,
};

/// Runs small scenes and prints a checksum of each field and table that they write; exits with 1 if any differs from
/// those of `--compare`
#[derive(clap::Args, Clone, Debug)]
pub struct Args {
    /// Folder of the scenes
    #[arg(long, value_name = "DIR", default_value = "harness/tests/fingerprints")]
    pub scenes: PathBuf,
    /// Record of an earlier call with `--json`, to compare with
    #[arg(long, value_name = "FILE")]
    pub compare: Option<PathBuf>,
    /// Part of the name of the adapter to compute on [default: the first GPU, else a CPU]
    #[arg(long, value_name = "NAME")]
    pub adapter: Option<String>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// Checksums of quantities: `SCENE/FILE` of a table, `SCENE/FILE:ARRAY` of an array of a VTK file.
type Sums = BTreeMap<String, String>;

/// The checksums, and where they were computed.
#[derive(Serialize)]
struct Record {
    machine: Machine,
    sums: Sums,
}

/// The parts of an earlier record that are compared; the last bits also depend on adapter and driver.
#[derive(Deserialize)]
struct Earlier {
    machine: BTreeMap<String, serde_json::Value>,
    sums: Sums,
}

/// Runs the scenes, prints their checksums, and returns whether they equal those of `--compare`.
pub fn run(args: &Args, stop: &AtomicBool) -> Result<bool> {
    let earlier = args.compare.as_deref().map(read).transpose()?;
    let machine = Machine::of(&gpu::pick(args.adapter.as_deref())?.get_info());
    let temporary = tempfile::tempdir().context("cannot make a temporary folder")?;
    let sums = fingerprints(args, temporary.path(), stop)?;
    let record = Record { machine, sums };
    if args.json {
        print::print_json(&record)?;
    } else {
        let Machine {
            adapter,
            backend,
            driver,
            ..
        } = &record.machine;
        let mut text = format!("# {adapter} ({backend}, {driver})\n");
        for (quantity, sum) in &record.sums {
            writeln!(text, "{quantity} {sum}")?;
        }
        print::print(&text)?;
    }
    Ok(earlier.is_none_or(|earlier| same(&earlier, &record)))
}

fn read(path: &Path) -> Result<Earlier> {
    let text = fs::read_to_string(path).map_err(|error| Error::file(path, error.to_string()))?;
    serde_json::from_str(&text).map_err(|error| {
        let message = format!("not a record of `riprap fingerprint --json`: {error}");
        Error::file(path, message).into()
    })
}

/// Whether the checksums are equal; reports those that are not.
fn same(earlier: &Earlier, now: &Record) -> bool {
    let machine = [
        &now.machine.adapter,
        &now.machine.backend,
        &now.machine.driver,
    ];
    for (key, is) in ["adapter", "backend", "driver"].into_iter().zip(machine) {
        if let Some(was) = earlier.machine.get(key).filter(|was| *was != is) {
            eprintln!("warning: {key} {is:?} is not that of the record, {was}: bits may differ");
        }
    }
    let keys: BTreeSet<_> = earlier.sums.keys().chain(now.sums.keys()).collect();
    let shown = |sum: Option<&String>| sum.map_or("absent".into(), String::clone);
    let mut same = true;
    for key in keys {
        let (was, is) = (earlier.sums.get(key), now.sums.get(key));
        if was != is {
            eprintln!("{key}: {} -> {}", shown(was), shown(is));
            same = false;
        }
    }
    same
}

/// The checksums of all scenes, run into folders in `temporary`.
fn fingerprints(args: &Args, temporary: &Path, stop: &AtomicBool) -> Result<Sums> {
    let mut sums = Sums::new();
    for scene in files(&args.scenes)? {
        if scene
            .extension()
            .is_some_and(|extension| extension == "toml")
        {
            let folder = temporary.join(scene.file_stem().unwrap_or_default());
            fingerprint(&scene, &folder, args.adapter.as_deref(), stop, &mut sums)
                .with_context(|| format!("scene {}", scene.display()))?;
        }
    }
    if sums.is_empty() {
        return Err(Error::file(&args.scenes, "no scenes (*.toml) in this folder").into());
    }
    Ok(sums)
}

/// The files of `folder`, in order.
fn files(folder: &Path) -> Result<Vec<PathBuf>> {
    let read = |error: std::io::Error| Error::file(folder, error.to_string());
    let entries = fs::read_dir(folder).map_err(read)?;
    let mut paths = entries
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<std::io::Result<Vec<_>>>()
        .map_err(read)?;
    paths.sort();
    Ok(paths)
}

/// Runs `scene` into `folder` and adds the checksums of the files written.
fn fingerprint(
    scene: &Path,
    folder: &Path,
    adapter: Option<&str>,
    stop: &AtomicBool,
    sums: &mut Sums,
) -> Result<()> {
    let run_args = run::Args {
        scene: scene.into(),
        out: Some(folder.into()),
        adapter: adapter.map(Into::into),
        ..run::Args::default()
    };
    let summary = run::run(&run_args, stop)?;
    if !summary.complete {
        bail!("the run ended at step {}, before its end", summary.steps);
    }
    let stem = scene.file_stem().unwrap_or_default().to_string_lossy();
    for path in files(folder)? {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let (quantity, bytes) = (format!("{stem}/{name}"), fs::read(&path)?);
        match path.extension().and_then(|extension| extension.to_str()) {
            Some("csv") => {
                sums.insert(quantity, checksum(&bytes));
            }
            Some("vti" | "vtu" | "vtp") => {
                let arrays = arrays(&bytes);
                let arrays = arrays.with_context(|| format!("{name} has no raw arrays"))?;
                for (array, bytes) in arrays {
                    sums.insert(format!("{quantity}:{array}"), checksum(bytes));
                }
            }
            _ => {}
        }
    }
    Ok(())
}

/// CRC-32 of `bytes` and their number, both hexadecimal.
fn checksum(bytes: &[u8]) -> String {
    format!("{:08x}-{:x}", crc32fast::hash(bytes), bytes.len())
}

/// Names and bytes of the appended arrays of a VTK XML file with 64-bit lengths.
fn arrays(file: &[u8]) -> Option<Vec<(String, &[u8])>> {
    let mark = b"<AppendedData encoding=\"raw\">";
    let at = file.windows(mark.len()).position(|part| part == mark)?;
    let head = std::str::from_utf8(&file[..at]).ok()?;
    let start = at + file[at..].iter().position(|byte| *byte == b'_')? + 1;
    let value = |element: &str, key: &str| {
        let (_, rest) = element.split_once(&format!(" {key}=\""))?;
        Some(rest.split_once('"')?.0.to_owned())
    };
    let elements = head.split("<DataArray").skip(1);
    elements
        .map(|element| {
            let data = &file[start..];
            let offset: usize = value(element, "offset")?.parse().ok()?;
            let (length, data) = data.get(offset..)?.split_first_chunk()?;
            let length = usize::try_from(u64::from_le_bytes(*length)).ok()?;
            Some((value(element, "Name")?, data.get(..length)?))
        })
        .collect()
}
