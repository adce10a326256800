//! `riprap report`: work–precision diagrams. Error against run time and against updates, every setting on one plot, and the
//! conclusions for the defaults.
//!
//! A class of scenes is a case of [`crate::validate`], run with several settings on several grids. Each point is a row that is on
//! disk before the next one begins; a run that diverges is a row with a note.

mod blocks;
mod class;
mod document;
mod estimate;
mod finding;
mod flows;
mod page;
mod row;
mod water;

pub use document::{Repeat, Report, Time};
pub use finding::{Choice, Finding, TARGETS};
pub use row::{Row, Table};

use crate::{
    bench::Machine,
    print::{duration, percent},
    validate::CaseContext,
};
use anyhow::Context;
use class::{Class, Point, Reference, classes, limit};
use estimate::Estimate;
use riprap::output::replace;
use std::{path::PathBuf, time::Instant};

/// Draws error against run time and updates for every setting, and says which is the cheapest.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct Args {
    /// Finer grids and more combinations, for a GPU; the short form takes less than five minutes on two cores
    #[arg(long)]
    pub full: bool,
    /// Folder for report.html, report.csv, report.json and a PNG of each class
    #[arg(long, value_name = "DIR", default_value = "out/report")]
    pub out: PathBuf,
    /// Classes of scenes, such as `cube-*` [default: all]
    #[arg(long, value_name = "GLOB")]
    pub case: Option<String>,
    /// Continue the report.csv in the folder, which this adapter began: points that it contains are not run again
    #[arg(long)]
    pub resume: bool,
    /// Part of the name of the adapter to use
    #[arg(long, value_name = "NAME")]
    pub adapter: Option<String>,
}

/// Measures the classes and writes the report. A point that breaks off is a row, not an error.
pub fn run(args: &Args) -> anyhow::Result<()> {
    let classes = select(args)?;
    let context = CaseContext::open(args.adapter.as_deref(), args.full)?;
    let folder = &args.out;
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    let path = folder.join("report.csv");
    let info = context.device.adapter_info();
    let form = if args.full { "full" } else { "short" };
    let own = format!("{form} form on {} ({})\n", info.name, info.driver_info);
    same_conditions(args, &own)?;
    let mut table = match args.resume {
        true => Table::resume(&path)?,
        false => Table::create(&path)?,
    };
    let mut report = Report {
        machine: Machine::of(&context.device.adapter_info()),
        full: args.full,
        time: match context.software {
            true => Time::Cpu,
            false => Time::Wall,
        },
        repeats: Vec::new(),
        rows: Vec::new(),
        findings: Vec::new(),
    };
    let begin = Instant::now();
    let mut estimate = Estimate::of(&classes);
    println!("{estimate}");
    for class in &classes {
        let points = class.points.len();
        println!("{}: {}; {points} points", class.name, class.title);
        measure(&context, class, &mut table)?;
        report.rows.clone_from(&table.rows);
        report.repeats.extend(report.repeat(&context, class));
        report.conclude(&classes);
        report.write(folder, &classes)?;
        let chart = report.chart_of_time(class);
        chart.draw(&folder.join(format!("{}.png", class.name.replace('-', "_"))))?;
        if let Some(left) = estimate.after(class, begin.elapsed().as_secs_f64()) {
            println!("     {left}");
        }
    }
    println!("{}", report.noise_says());
    println!("{}", report.verdict());
    println!(
        "{} in {}",
        folder.join("report.html").display(),
        duration(begin.elapsed().as_secs_f64())
    );
    Ok(())
}

/// Records the form and the adapter of the rows in the folder; refuses to add rows of others to them.
fn same_conditions(args: &Args, own: &str) -> anyhow::Result<()> {
    let path = args.out.join("conditions.txt");
    // Older reports have no such file.
    let written = std::fs::read_to_string(&path).ok();
    if let Some(other) = written.filter(|other| args.resume && *other != own) {
        anyhow::bail!(
            "{} has rows of the {}, these would be of the {}: go on in the same form (--full) on the same --adapter, or \
             give another --out",
            args.out.display(),
            other.trim_end(),
            own.trim_end()
        );
    }
    Ok(replace(&path, |file| file.write_all(own.as_bytes()))?)
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

/// Computes the points of a class that the table lacks; each row is written to disk when it is done.
fn measure(context: &CaseContext, class: &Class, table: &mut Table) -> anyhow::Result<()> {
    let mut reference = match class.reference {
        Reference::None => Some((None, 0.0)),
        Reference::Known(value, uncertainty) => Some((Some(value), uncertainty)),
        Reference::Limit => None,
        Reference::Recorded(values) => {
            let (limit, uncertainty) = limit(values);
            Some((Some(limit), uncertainty))
        }
    };
    for (n, point) in class.points.iter().enumerate() {
        if table.find(class.name, point).is_none() {
            let mut row = computed(context, class, point);
            if let Some((reference, uncertainty)) = reference {
                row.compare(reference, uncertainty);
            }
            println!("{}", told(&row));
            table.push(row)?;
        }
        if reference.is_none() && n == 2 {
            let three = class.points[..3]
                .iter()
                .map(|point| table.find(class.name, point)?.value);
            // Without these three grids a class has values, but no errors.
            if let Some(values) = three.collect::<Option<Vec<f64>>>()
                && let Some(values) = values.first_chunk::<3>()
            {
                let (limit, uncertainty) = limit(*values);
                println!(
                    "     limit {limit:.6}, off by at most {}",
                    percent(uncertainty)
                );
                let all = table.rows.iter_mut().filter(|row| row.class == class.name);
                all.for_each(|row| row.compare(Some(limit), uncertainty));
                table.write()?;
                reference = Some((Some(limit), uncertainty));
            }
        }
    }
    Ok(())
}

fn computed(context: &CaseContext, class: &Class, point: &Point) -> Row {
    let mut row = Row {
        class: class.name.into(),
        setting: point.setting.clone(),
        default: point.default,
        resolution: point.resolution,
        ..Row::default()
    };
    row.take((point.run)(context));
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_another_form_are_not_gone_on_with() {
        let out = tempfile::tempdir().unwrap();
        let args = |resume| Args {
            resume,
            out: out.path().into(),
            ..Args::default()
        };
        same_conditions(&args(true), "short form on a\n").unwrap();
        same_conditions(&args(true), "short form on a\n").unwrap();
        let refused = same_conditions(&args(true), "full form on a\n");
        let anew = same_conditions(&args(false), "full form on a\n");
        let told = refused.unwrap_err().to_string();
        assert!(
            told.contains("short form") && told.contains("--full"),
            "{told}"
        );
        anew.unwrap();
    }
}
