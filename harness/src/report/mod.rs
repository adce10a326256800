//! `riprap report`: work–precision diagrams. Error against run time and against updates, every setting on one plot, and
//! what follows from them for the defaults.
//!
//! A class of scenes is a case of [`crate::validate`] that is run by several settings on several grids. Each point is a
//! row that is on disk before the next one begins; one that diverges is a row that says so.

mod blocks;
mod class;
mod finding;
mod flows;
mod limit;
mod page;
mod plot;
mod row;
mod svg;
mod water;

pub use finding::{Choice, Finding, TARGETS};
use row::Cost;
pub use row::{Row, Table};

use crate::{
    bench::Machine,
    picture::{Chart, Curve, Mark, Measure},
    print::percent,
    validate::Stand,
};
use anyhow::Context;
use class::{Class, Point, Reference, classes};
use riprap::output::replace;
use serde::Serialize;
use std::{
    path::{Path, PathBuf},
    time::Instant,
};

/// Draws error against run time and updates for every setting, and says which is the cheapest.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct Args {
    /// Finer grids, for a GPU; the short form takes minutes on two cores
    #[arg(long)]
    pub full: bool,
    /// Folder for report.html, report.csv, report.json and a PNG of each class
    #[arg(long, value_name = "DIR", default_value = "out/report")]
    pub out: PathBuf,
    /// Classes of scenes, such as `cube-*`; all without it
    #[arg(long, value_name = "GLOB")]
    pub case: Option<String>,
    /// Part of the name of the adapter to use
    #[arg(long, value_name = "NAME")]
    pub adapter: Option<String>,
}

/// What counts as run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Time {
    /// CPU time of all threads: a busy machine distorts it least.
    Cpu,
    /// By the clock on the wall.
    Wall,
}

impl Time {
    fn of(self) -> Cost {
        match self {
            Self::Cpu => |row| row.cpu_seconds,
            Self::Wall => |row| row.wall_seconds,
        }
    }

    fn axis(self) -> &'static str {
        match self {
            Self::Cpu => "CPU time, all threads, s",
            Self::Wall => "run time, s",
        }
    }

    fn says(self) -> &'static str {
        match self {
            Self::Cpu => {
                "the CPU time of the steps, of all threads together, without read-outs and without the first four, at which \
                 the driver compiles"
            }
            Self::Wall => {
                "the time of the steps by the clock on the wall, without read-outs and without the first four, at which the \
                 driver compiles"
            }
        }
    }
}

/// A run that was done twice.
#[derive(Clone, Debug, Serialize)]
pub struct Repeat {
    /// Class of scenes.
    pub class: String,
    /// Resolution.
    pub resolution: f64,
    /// Its run time both times, s.
    pub seconds: [f64; 2],
}

/// All that was measured.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Where and when.
    #[serde(flatten)]
    pub machine: Machine,
    /// Whether in the full form.
    pub full: bool,
    /// What counts as run time.
    pub time: Time,
    /// Runs that were done twice.
    pub repeats: Vec<Repeat>,
    /// The rows.
    pub rows: Vec<Row>,
    /// What follows from them.
    pub findings: Vec<Finding>,
}

/// Measures and writes.
///
/// # Errors
/// If no class matches, there is no adapter, or a file cannot be written. A point that breaks off is a row.
pub fn run(args: &Args) -> anyhow::Result<()> {
    let classes = select(args)?;
    let stand = Stand::open(args.adapter.as_deref(), args.full)?;
    let folder = &args.out;
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    let mut table = Table::create(&folder.join("report.csv"))?;
    let mut report = Report {
        machine: Machine::of(&stand.device.adapter_info()),
        full: args.full,
        time: match stand.software {
            true => Time::Cpu,
            false => Time::Wall,
        },
        repeats: Vec::new(),
        rows: Vec::new(),
        findings: Vec::new(),
    };
    let begin = Instant::now();
    for class in &classes {
        println!("{}: {}", class.name, class.title);
        measure(&stand, class, &mut table)?;
        report.rows.clone_from(&table.rows);
        report.repeats.extend(report.repeat(&stand, class));
        report.conclude(&classes);
        report.write(folder, &classes)?;
        let chart = report.chart(class);
        chart.draw(&folder.join(format!("{}.png", class.name)))?;
    }
    println!("{}", report.noise_says());
    println!("{}", report.verdict());
    println!(
        "{} in {}",
        folder.join("report.html").display(),
        crate::print::duration(begin.elapsed().as_secs_f64())
    );
    Ok(())
}

/// The classes that match.
fn select(args: &Args) -> anyhow::Result<Vec<Class>> {
    let text = args.case.as_deref().unwrap_or("*");
    let pattern =
        glob::Pattern::new(text).with_context(|| format!("--case {text} is no pattern"))?;
    let all = classes(args.full);
    let names: Vec<_> = all.iter().map(|class| class.name).collect();
    let names = names.join(", ");
    let found: Vec<_> = all
        .into_iter()
        .filter(|class| pattern.matches(class.name))
        .collect();
    anyhow::ensure!(
        !found.is_empty(),
        "no class matches --case {text}; there are: {names}"
    );
    Ok(found)
}

/// Computes a class; its rows are on disk as they come.
fn measure(stand: &Stand, class: &Class, table: &mut Table) -> anyhow::Result<()> {
    let first = table.rows.len();
    let mut reference = match class.reference {
        Reference::None => Some((None, 0.0)),
        Reference::Known(value, uncertainty) => Some((Some(value), uncertainty)),
        Reference::Limit => None,
    };
    for (n, point) in class.points.iter().enumerate() {
        let mut row = computed(stand, class, point);
        if let Some((reference, uncertainty)) = reference {
            row.compare(reference, uncertainty);
        }
        println!("{}", told(&row));
        table.push(row)?;
        if reference.is_none() && n == 2 {
            let values: Vec<f64> = table.rows[first..].iter().filter_map(|r| r.value).collect();
            // Without its three grids a class has values, and no errors.
            if let Some(values) = values.first_chunk::<3>() {
                let (limit, uncertainty) = limit::limit(*values);
                println!(
                    "     limit {limit:.6}, off by at most {}",
                    percent(uncertainty)
                );
                for row in &mut table.rows[first..] {
                    row.compare(Some(limit), uncertainty);
                }
                table.write()?;
                reference = Some((Some(limit), uncertainty));
            }
        }
    }
    Ok(())
}

fn computed(stand: &Stand, class: &Class, point: &Point) -> Row {
    let mut row = Row {
        class: class.name.into(),
        setting: point.setting.clone(),
        default: point.default,
        resolution: point.resolution,
        ..Row::default()
    };
    row.take((point.run)(stand));
    row
}

/// A row as a line of the terminal.
fn told(row: &Row) -> String {
    format!(
        "     {:24} {:>7.1} {:>10} {:>9.2e} updates {:>8.2} s CPU {:>8.2} s  {}",
        row.setting,
        row.resolution,
        row.error.map_or("-".into(), percent),
        row.updates as f64,
        row.cpu_seconds,
        row.wall_seconds,
        row.note
    )
}

impl Report {
    /// The rows of a class.
    fn of(&self, class: &str) -> Vec<&Row> {
        self.rows.iter().filter(|row| row.class == class).collect()
    }

    /// Runs the longest short run with the defaults of a class again.
    fn repeat(&self, stand: &Stand, class: &Class) -> Option<Repeat> {
        /// Longest run that is done twice, s.
        const SHORT: f64 = 4.0;
        let time = self.time.of();
        let rows = self.of(class.name);
        let (row, point) = rows
            .iter()
            .zip(&class.points)
            .filter(|(row, point)| point.default && row.error.is_some() && time(row) < SHORT)
            .max_by(|(a, _), (b, _)| time(a).total_cmp(&time(b)))?;
        let again = computed(stand, class, point);
        Some(Repeat {
            class: class.name.into(),
            resolution: row.resolution,
            seconds: [time(row), time(&again)],
        })
    }

    /// How far run times differ from run to run.
    fn noise_says(&self) -> String {
        let apart = |repeat: &Repeat| {
            let [a, b] = repeat.seconds;
            (a - b).abs() / a.min(b)
        };
        let mut all: Vec<f64> = self.repeats.iter().map(apart).collect();
        all.sort_by(f64::total_cmp);
        match (all.get(all.len() / 2), all.last()) {
            (Some(middle), Some(most)) => format!(
                "Noise: of {} runs that were done twice, one a class, the times differ by {} (median), at most {}.",
                all.len(),
                percent(*middle),
                percent(*most)
            ),
            _ => "Noise: no run was done twice.".into(),
        }
    }

    /// Names of the costs.
    fn costs(&self) -> [&'static str; 2] {
        ["run time", "updates"]
    }

    /// Finds the cheapest settings.
    fn conclude(&mut self, classes: &[Class]) {
        let [time, updates] = self.costs();
        let all: [Cost; 2] = [self.time.of(), |row| row.updates as f64];
        let costs = [(time, all[0]), (updates, all[1])];
        let findings = classes.iter().flat_map(|class| {
            let rows = self.of(class.name);
            let asked = TARGETS
                .iter()
                .flat_map(|target| costs.map(|cost| (*target, cost)));
            let asked = asked.filter(|_| !rows.is_empty());
            let found = asked.map(|(target, cost)| Finding::of(class.name, &rows, target, cost));
            found.collect::<Vec<_>>()
        });
        self.findings = findings.collect();
    }

    /// Whether the defaults follow from the findings, in words.
    fn verdict(&self) -> String {
        let reached: Vec<_> = self
            .findings
            .iter()
            .filter(|f| f.cheapest.is_some())
            .collect();
        let others: Vec<String> = reached
            .iter()
            .filter(|finding| finding.follows() == Some(false))
            .map(|finding| {
                let by = finding.cheapest.as_ref().map_or("", |c| c.setting.as_str());
                let cost = match finding.ratio() {
                    Some(ratio) => format!("{ratio:.1} times the {} of {by}", finding.cost),
                    None => format!("{by} reaches it, the default does not"),
                };
                format!("{} at {} ({cost})", finding.class, percent(finding.target))
            })
            .collect();
        let mut text = format!(
            "The defaults are the cheapest, or cost at most {} times the least, in {} of {} questions",
            finding::SAME,
            reached.len() - others.len(),
            reached.len()
        );
        if !others.is_empty() {
            text += &format!("; not for {}", others.join("; "));
        }
        text + "."
    }

    /// The diagram of a class over run time, as a picture.
    fn chart(&self, class: &Class) -> Chart {
        let time = self.time.of();
        let mut curves: Vec<Curve> = Vec::new();
        for row in self.of(class.name) {
            let Some(error) = row.certain_error().filter(|error| *error > 0.0) else {
                continue;
            };
            let at = curves.iter().position(|curve| curve.name == row.setting);
            let at = at.unwrap_or_else(|| {
                curves.push(Curve {
                    name: row.setting.clone(),
                    points: Vec::new(),
                    mark: Mark::LinePoints,
                });
                curves.len() - 1
            });
            curves[at].points.push([time(row), 100.0 * error]);
        }
        for curve in &mut curves {
            curve.points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        }
        let (name, unit) = match self.time {
            Time::Cpu => ("CPU time of all threads", "s"),
            Time::Wall => ("run time", "s"),
        };
        Chart::profile(
            class.title,
            Measure::logarithmic(name, unit),
            Measure::logarithmic("error", "%"),
            curves,
        )
    }

    /// Writes the page and the JSON.
    fn write(&self, folder: &Path, classes: &[Class]) -> anyhow::Result<()> {
        let json = serde_json::to_string_pretty(self)? + "\n";
        let html = page::page(self, classes);
        for (name, text) in [("report.json", json), ("report.html", html)] {
            replace(&folder.join(name), |file| file.write_all(text.as_bytes()))?;
        }
        Ok(())
    }
}
