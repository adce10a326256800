//! `riprap records`: makes the records of an adapter at one commit, one after the other, and renders the tables of the
//! documentation from them.
//!
//! Each record is made by its own process, so that a crash does not affect the others. When a record is complete it replaces the
//! former one; `index.json` holds the commit and the duration of each.

mod index;
mod tables;

use crate::{bench::Machine, gpu, validate};
use anyhow::{Context, bail};
use index::{Entry, Index, Verdict};
use riprap::output::replace;
use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
    sync::atomic::{AtomicBool, Ordering},
    time::Instant,
};

/// Makes the records of this machine at the current commit: every case of validate, every part of bench, the report, and the
/// stability maps; then renders the tables of README.md and docs from them.
///
/// A record that the current commit already has is not made again, so that an interrupted call can be repeated.
#[derive(Clone, Debug, clap::Args)]
pub struct Args {
    /// Records whose names match, such as `validate/rock/*` or `bench/*` [default: all]
    #[arg(long, value_name = "GLOB")]
    pub only: Option<String>,
    /// The long forms, which take hours on a CPU
    #[arg(long)]
    pub full: bool,
    /// Only render the tables
    #[arg(long, conflicts_with_all = ["only", "full", "adapter"])]
    pub render: bool,
    /// Folder of the records
    #[arg(long, value_name = "DIR", default_value = "harness/results/records")]
    pub folder: PathBuf,
    /// Part of the name of the adapter to use
    #[arg(long, value_name = "NAME")]
    pub adapter: Option<String>,
}

/// Documents with tables of records, from the root of the repository.
const DOCUMENTS: [&str; 3] = [
    "README.md",
    "docs/src/validation.md",
    "docs/src/performance.md",
];

/// A record: its name, which is also the path of its file or folder, and the command that makes it.
struct Job {
    name: String,
    only_full: bool,
    /// Arguments of `riprap` in the short form.
    short: Vec<&'static str>,
    /// Arguments in the long form.
    full: Vec<&'static str>,
    /// The option that takes the output path.
    target: &'static str,
}

impl Job {
    fn file(&self) -> String {
        if self.target == "--json" {
            format!("{}.json", self.name)
        } else {
            self.name.clone()
        }
    }
}

/// Recorded grids of the fluid.
const GRIDS: &[&str] = &["--only", "fluid", "--grid", "64", "--grid", "128"];

/// All records, in the order in which they are made.
fn jobs() -> Vec<Job> {
    let cases = validate::CASES.iter().map(|case| Job {
        name: format!("validate/{}", case.name),
        only_full: case.only_full,
        short: vec!["validate", "--case", case.name],
        full: vec!["validate", "--full", "--case", case.name],
        target: "--json",
    });
    let benches = [
        ("fluid", GRIDS, GRIDS),
        (
            "rock",
            &["--only", "rock", "--quick"],
            &["--only", "rock", "--full"],
        ),
        (
            "water",
            &["--only", "water"],
            &["--only", "water", "--full"],
        ),
        (
            "solids",
            &["--only", "solids"],
            &["--only", "solids", "--full"],
        ),
        ("unused", &["--only", "unused"], &["--only", "unused"]),
        ("all", &[], &["--all"]),
        ("device", &["--device"], &["--device"]),
    ];
    let benches = benches.map(|(name, short, full): (&str, &[_], &[_])| Job {
        name: format!("bench/{name}"),
        only_full: short.is_empty(),
        short: [&["bench"], short].concat(),
        full: [&["bench"], full].concat(),
        target: "--json",
    });
    let folders = ["report", "stress"].map(|name| Job {
        name: name.into(),
        only_full: false,
        short: vec![name],
        full: vec![name, "--full"],
        target: "--out",
    });
    cases.chain(benches).chain(folders).collect()
}

/// Makes the records that the current commit lacks, and renders the tables. Returns whether all that ran met their limits.
/// A record that breaks off is an entry of the index; the former record stays.
pub fn run(args: &Args, stop: &AtomicBool) -> anyhow::Result<bool> {
    let good = if args.render { true } else { make(args, stop)? };
    let machines = Index::all(&args.folder)?;
    for path in DOCUMENTS.map(Path::new) {
        let text = fs::read_to_string(path).with_context(|| {
            format!(
                "cannot read {}; call this in the root of the repository",
                path.display()
            )
        })?;
        let rendered =
            tables::render(&text, &machines).with_context(|| path.display().to_string())?;
        if rendered != text {
            replace(path, |file| file.write_all(rendered.as_bytes()))?;
            println!("{} has new tables", path.display());
        }
    }
    Ok(good)
}

fn make(args: &Args, stop: &AtomicBool) -> anyhow::Result<bool> {
    let pattern = args.only.as_deref().unwrap_or("*");
    let glob = glob::Pattern::new(pattern).with_context(|| format!("--only {pattern}"))?;
    let jobs = jobs();
    let chosen: Vec<_> = jobs.iter().filter(|job| glob.matches(&job.name)).collect();
    if chosen.is_empty() {
        let names: Vec<_> = jobs.iter().map(|job| job.name.as_str()).collect();
        bail!(
            "no record matches --only {pattern}; there are: {}",
            names.join(", ")
        );
    }
    let commit = commit(&args.folder)?;
    let machine = Machine::of(&gpu::pick(args.adapter.as_deref())?.get_info());
    let folder = args.folder.join(machine.slug());
    let mut index = Index::read(&folder)?;
    let mut good = true;
    for job in chosen {
        if job.only_full && !args.full {
            println!("{}: left out, it runs with --full", job.name);
            continue;
        }
        if index.has(&job.name, &commit, args.full) {
            println!("{}: kept, it is of this commit", job.name);
            continue;
        }
        if stop.load(Ordering::Relaxed) {
            println!("stopped; repeat the command to go on");
            return Ok(false);
        }
        println!("{}", job.name);
        let begin = Instant::now();
        let verdict = execute(job, args, &folder)?;
        good &= verdict == Verdict::Passed;
        index.entries.insert(
            job.name.clone(),
            Entry {
                verdict,
                commit: commit.clone(),
                date: Machine::host().date,
                full: args.full,
                seconds: begin.elapsed().as_secs_f64(),
            },
        );
        index.write(&folder, &machine)?;
    }
    Ok(good)
}

/// Runs the command of a record and replaces the former record with its output.
fn execute(job: &Job, args: &Args, folder: &Path) -> anyhow::Result<Verdict> {
    let target = folder.join(job.file());
    let draft = target.with_extension("draft");
    let parent = target.parent().unwrap_or(folder);
    fs::create_dir_all(parent).with_context(|| format!("cannot make {}", parent.display()))?;
    let mut command = Command::new(std::env::current_exe().context("cannot find this program")?);
    command.args(if args.full { &job.full } else { &job.short });
    command.arg(job.target).arg(&draft);
    if let Some(adapter) = &args.adapter {
        command.args(["--adapter", adapter]);
    }
    let status = command
        .status()
        .context("cannot start this program again")?;
    let verdict = match status.code() {
        Some(0) => Verdict::Passed,
        // The exit code for a missed limit, if the command completed.
        Some(1) if draft.exists() => Verdict::Missed,
        _ => {
            println!("{} broke off: {status}; the former record stays", job.name);
            return Ok(Verdict::BrokeOff);
        }
    };
    if target.is_dir() {
        fs::remove_dir_all(&target)
            .with_context(|| format!("cannot remove {}", target.display()))?;
    }
    fs::rename(&draft, &target).with_context(|| format!("cannot write {}", target.display()))?;
    Ok(verdict)
}

/// The commit of the working tree, which must have no changes except in records and documents.
fn commit(records: &Path) -> anyhow::Result<String> {
    let git = |arguments: &[&str]| -> anyhow::Result<String> {
        let out = Command::new("git").args(arguments).output();
        let out = out.context("cannot run git, which names the commit of a record")?;
        if !out.status.success() {
            let reason = String::from_utf8_lossy(&out.stderr).trim().to_owned();
            bail!("git {}: {reason}", arguments.join(" "));
        }
        Ok(String::from_utf8_lossy(&out.stdout).trim().to_owned())
    };
    let records = format!(":!{}", records.display());
    let mut arguments = vec!["status", "--porcelain", "--", ".", &records];
    let documents = DOCUMENTS.map(|document| format!(":!{document}"));
    arguments.extend(documents.iter().map(String::as_str));
    let changes = git(&arguments)?;
    if let Some(first) = changes.lines().next() {
        bail!(
            "the working tree has changes that no commit has, such as {:?}; commit them, so that records name what they are of",
            first.trim()
        );
    }
    git(&["rev-parse", "--short=12", "HEAD"])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn documents_have_the_tables_of_the_kept_records() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let machines = Index::all(&root.join("harness/results/records")).unwrap();
        assert!(!machines.is_empty());
        for document in DOCUMENTS {
            let text = fs::read_to_string(root.join(document)).unwrap();
            let rendered = tables::render(&text, &machines).unwrap();
            assert!(
                rendered == text,
                "{document}: call `riprap records --render`"
            );
        }
    }

    #[test]
    fn names_of_records_are_unique_and_their_commands_exist() {
        let jobs = jobs();
        let mut names: Vec<_> = jobs.iter().map(|job| &job.name).collect();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), jobs.len());
        for job in &jobs {
            assert!(
                job.only_full || job.short.len() <= job.full.len() + 1,
                "{}",
                job.name
            );
        }
    }
}
