//! Tables of the documentation, rendered from records.
//!
//! A document marks the position of a table by two comments:
//!
//! ```text
//! <!-- records: validate solids/* -->
//! <!-- end of records -->
//! ```
//!
//! `validate GLOB...` shows the limits of each case, `values GLOB...` all its values, `bench PART` one line for each row of the
//! benchmark, `targets PART` its targets, and `headline` the limits of the front page; `tables.toml` defines the columns and the
//! headlines. The text between the comments is replaced.

use super::index::Index;
use crate::validate::{self, Case};
use anyhow::{Context, bail};
use serde::Deserialize;
use serde_json::{Map, Value};
use std::{collections::BTreeMap, fmt::Write};

const BEGIN: &str = "<!-- records: ";
const END: &str = "<!-- end of records -->";
/// Suffix of a result that missed its limit.
const MISSED: &str = ", **missed**";

/// Returns `text` with its tables rendered from the records of `machines`.
pub fn render(text: &str, machines: &[Index]) -> anyhow::Result<String> {
    let mut rendered = String::new();
    let mut rest = text;
    while let Some(at) = rest.find(BEGIN) {
        let mark = &rest[at..];
        let line = mark.lines().next().unwrap_or_default();
        let request = line[BEGIN.len()..].trim_end().strip_suffix("-->");
        let request = request
            .with_context(|| format!("{line:?} does not end with -->"))?
            .trim();
        let end = mark
            .find(END)
            .with_context(|| format!("{line:?} has no {END:?}"))?;
        write!(
            rendered,
            "{}{line}\n{}",
            &rest[..at],
            table(request, machines).with_context(|| line.to_owned())?
        )?;
        rest = &mark[end..];
    }
    Ok(rendered + rest)
}

/// A table of a document, with its column heads.
#[derive(Default)]
struct Table {
    heads: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    fn new(heads: &[&str]) -> Self {
        Self {
            heads: heads.iter().map(|head| (*head).into()).collect(),
            rows: Vec::new(),
        }
    }

    fn markdown(&self) -> String {
        let line = |cells: &Vec<String>| {
            let escaped: Vec<_> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
            format!("| {} |\n", escaped.join(" | "))
        };
        let rule = "|---".repeat(self.heads.len()) + "|\n";
        let rows: String = self.rows.iter().map(line).collect();
        line(&self.heads) + &rule + &rows
    }
}

fn table(request: &str, machines: &[Index]) -> anyhow::Result<String> {
    if request == "headline" {
        return Ok(format!("\n{}\n", headline(machines)?.markdown()));
    }
    let mut text = String::new();
    for index in machines {
        let table = match request.split_once(' ') {
            Some(("validate", patterns)) => limits(index, &cases(patterns)?)?,
            Some(("values", patterns)) => values(index, &cases(patterns)?)?,
            Some(("bench", part)) => bench(index, part)?,
            Some(("targets", part)) => targets(index, part)?,
            _ => bail!(
                "there is no such table: validate GLOB, values GLOB, bench PART, targets PART and headline are known"
            ),
        };
        if !table.rows.is_empty() {
            write!(text, "\n{}\n*{}.*\n\n", table.markdown(), index.machine)?;
        }
    }
    Ok(text)
}

/// A row of a record of `riprap validate`.
#[derive(Clone, Debug, Deserialize)]
struct Measured {
    quantity: String,
    /// `None` if it is not a number.
    value: Option<f64>,
    reference: Option<f64>,
    error: Option<f64>,
    limit: Option<f64>,
    passed: bool,
    commit: Option<String>,
}

impl Measured {
    /// The error over the limit; infinite if a limit of zero is missed.
    fn share(&self) -> f64 {
        match (self.error, self.limit) {
            (Some(error), Some(limit)) if limit > 0.0 => error / limit,
            _ if self.passed => 0.0,
            _ => f64::INFINITY,
        }
    }

    fn value(&self) -> String {
        self.value.map_or("no number".into(), number)
    }

    /// The reference or bound of the value; `None` if the value is an error itself.
    fn compared(&self) -> Option<String> {
        let reference = self.reference.filter(|reference| *reference != 0.0)?;
        let kind = match self.limit == Some(0.0) {
            true => "bound",
            false => "reference",
        };
        Some(format!("{kind} {}", number(reference)))
    }

    /// The value, with its reference or bound.
    fn result(&self) -> String {
        let compared = self.compared().map(|with| format!(", {with}"));
        self.value() + &compared.unwrap_or_default()
    }

    /// The requirement on the value, and the value with its error, as shown on the front page.
    fn headline(&self) -> (String, String) {
        let most = format!("error at most {}", self.limit());
        let missed = if self.passed { "" } else { MISSED };
        let (wanted, found) = match (self.compared(), self.limit) {
            (None, _) => (most, self.value()),
            (Some(bound), Some(0.0)) => (bound, self.value()),
            (Some(with), _) => (
                format!("{with}, {most}"),
                format!("{}, error {}", self.value(), self.error()),
            ),
        };
        (wanted, found + missed)
    }

    /// `value` with the verdict on the row.
    fn judged(&self) -> String {
        self.result() + if self.passed { "" } else { MISSED }
    }

    fn error(&self) -> String {
        self.error.map_or("–".into(), number)
    }

    fn commit(&self) -> String {
        self.commit.clone().unwrap_or("unknown".into())
    }

    fn limit(&self) -> String {
        match self.limit {
            Some(limit) if limit > 0.0 => number(limit),
            Some(_) => "the bound".into(),
            None => "–".into(),
        }
    }
}

/// The cases that match one of the patterns.
fn cases(patterns: &str) -> anyhow::Result<Vec<Case>> {
    let found = patterns
        .split_whitespace()
        .map(|glob| validate::select(Some(glob)));
    Ok(found.collect::<anyhow::Result<Vec<_>>>()?.concat())
}

/// All values of the cases, each with its reference.
fn values(index: &Index, cases: &[Case]) -> anyhow::Result<Table> {
    let mut table = Table::new(&["quantity", "value", "error", "commit"]);
    for case in cases {
        let rows: Vec<Measured> = index.rows(&format!("validate/{}", case.name))?;
        let cells = |row: Measured| {
            vec![
                row.quantity.clone(),
                row.result(),
                row.error(),
                row.commit(),
            ]
        };
        table.rows.extend(rows.into_iter().map(cells));
    }
    Ok(table)
}

/// A line for each case: the number of limits it meets, each one that it misses, and the one of the others closest to its limit.
fn limits(index: &Index, cases: &[Case]) -> anyhow::Result<Table> {
    let mut table = Table::new(&[
        "case",
        "limits met",
        "quantity",
        "result",
        "error",
        "limit",
        "commit",
    ]);
    for case in cases {
        let rows: Vec<Measured> = index.rows(&format!("validate/{}", case.name))?;
        let judged = rows.iter().filter(|row| row.limit.is_some());
        let (met, mut shown): (Vec<&Measured>, Vec<_>) = judged.partition(|row| row.passed);
        let count = format!("{} of {}", met.len(), met.len() + shown.len());
        let nearest = met.iter().max_by(|a, b| a.share().total_cmp(&b.share()));
        shown.extend(nearest.copied());
        if shown.is_empty() {
            shown.extend(rows.first());
        }
        let mut about = [format!("`{}`: {}", case.name, case.about), count];
        for row in shown {
            let [name, count] = std::mem::take(&mut about);
            table.rows.push(vec![
                name,
                count,
                row.quantity.clone(),
                row.judged(),
                row.error(),
                row.limit(),
                row.commit(),
            ]);
        }
    }
    Ok(table)
}

/// Contents of the tables: `tables.toml`.
#[derive(Deserialize)]
struct Contents {
    /// Columns of the parts of the benchmark: the key of the record, and the column head.
    columns: BTreeMap<String, Vec<[String; 2]>>,
    headlines: Vec<Headline>,
    speeds: Vec<Speed>,
}

/// A result on the front page: its description, the case, and the prefix of the quantity.
#[derive(Deserialize)]
struct Headline {
    about: String,
    case: String,
    quantity: String,
}

/// A speed of the fluid on the front page, and the least MLUPS that it should reach.
#[derive(Deserialize)]
struct Speed {
    kernel: String,
    storage: String,
    grid: u64,
    limit: f64,
}

fn contents() -> anyhow::Result<Contents> {
    Ok(toml::from_str(include_str!("tables.toml"))?)
}

/// A row of a record of `riprap bench`.
type BenchRow = Map<String, Value>;

/// The rows of a part of the benchmark: only its targets, or all but these.
fn bench_rows(index: &Index, part: &str, targets: bool) -> anyhow::Result<Vec<BenchRow>> {
    let mut rows: Vec<BenchRow> = index.rows(&format!("bench/{part}"))?;
    rows.retain(|row| (word(row, "part") == "target") == targets);
    Ok(rows)
}

/// A text or a number of a row; a dash if it is neither.
fn word(row: &BenchRow, key: &str) -> String {
    match row.get(key) {
        Some(Value::Number(value)) => value.as_f64().map_or("–".into(), number),
        Some(Value::String(value)) => value.clone(),
        _ => "–".into(),
    }
}

fn bench(index: &Index, part: &str) -> anyhow::Result<Table> {
    let mut parts = contents()?.columns;
    let Some(mut columns) = parts.remove(part) else {
        let parts: Vec<_> = parts.into_keys().collect();
        bail!("bench has no part {part}; there are {}", parts.join(", "));
    };
    columns.push(["commit".into(), "commit".into()]);
    let mut table = Table::default();
    for row in bench_rows(index, part, false)? {
        // A record of several parts also has rows of other parts.
        if row.contains_key(&columns[0][0]) {
            let cells = columns.iter().map(|[key, _]| word(&row, key));
            table.rows.push(cells.collect());
        }
    }
    table.heads = columns.into_iter().map(|[_, head]| head).collect();
    Ok(table)
}

/// The targets of a part of the benchmark: the value found, and whether it meets the target.
fn targets(index: &Index, part: &str) -> anyhow::Result<Table> {
    let mut table = Table::new(&["target", "of", "result", "commit"]);
    for row in bench_rows(index, part, true)? {
        let found = row.get("found").and_then(Value::as_f64);
        let found = found.map_or("no number".into(), number);
        let met = row.get("met").and_then(Value::as_bool) == Some(true);
        table.rows.push(vec![
            word(&row, "says"),
            word(&row, "of"),
            found + if met { "" } else { MISSED },
            word(&row, "commit"),
        ]);
    }
    Ok(table)
}

/// The limits of the front page, with a column for each machine.
fn headline(machines: &[Index]) -> anyhow::Result<Table> {
    let contents = contents()?;
    let name = |index: &Index| {
        let end = index.machine.find([',', '(']);
        index.machine[..end.unwrap_or(index.machine.len())]
            .trim()
            .to_owned()
    };
    let mut table = Table::new(&["quantity", "wanted"]);
    table.heads.extend(machines.iter().map(name));
    // The requirement, and the result of each machine.
    let mut add = |about: String, found: Vec<Option<(String, String)>>| {
        let wanted = found
            .iter()
            .flatten()
            .map(|(wanted, _)| wanted.clone())
            .next();
        if let Some(wanted) = wanted {
            let none = || "–".to_owned();
            let found = found
                .into_iter()
                .map(|cell| cell.map_or_else(none, |(_, found)| found));
            table
                .rows
                .push([about, wanted].into_iter().chain(found).collect());
        }
    };
    for Headline {
        about,
        case,
        quantity,
    } in contents.headlines
    {
        let of = |index: &Index| {
            let rows: Vec<Measured> = index.rows(&format!("validate/{case}"))?;
            let shown =
                |row: &&Measured| row.quantity.starts_with(&quantity) && row.limit.is_some();
            Ok(rows.iter().find(shown).map(Measured::headline))
        };
        add(
            about,
            machines.iter().map(of).collect::<anyhow::Result<_>>()?,
        );
    }
    for Speed {
        kernel,
        storage,
        grid,
        limit,
    } in contents.speeds
    {
        let of = |index: &Index| {
            let rows = bench_rows(index, "fluid", false)?;
            let found = rows.iter().find(|row| {
                word(row, "variant") == kernel
                    && word(row, "storage") == storage
                    && row.get("grid").and_then(Value::as_u64) == Some(grid)
            });
            let mlups = found.and_then(|row| row.get("mlups")?.as_f64());
            let cell = |mlups: f64| {
                let missed = if mlups >= limit { "" } else { MISSED };
                (format!("at least {limit}"), number(mlups) + missed)
            };
            Ok(mlups.map(cell))
        };
        let about = format!("speed of the kernel {kernel} in {storage} on {grid}³ cells, MLUPS");
        add(
            about,
            machines.iter().map(of).collect::<anyhow::Result<_>>()?,
        );
    }
    Ok(table)
}

/// Four significant digits, without trailing zeros.
fn number(value: f64) -> String {
    let magnitude = value.abs();
    let trimmed = |text: String| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    };
    if value == 0.0 || (1e-3..1e6).contains(&magnitude) {
        let digits = (3 - magnitude.max(1e-3).log10().floor() as i32).max(0) as usize;
        return trimmed(format!("{value:.digits$}"));
    }
    let text = format!("{value:.3e}");
    match text.split_once('e') {
        Some((mantissa, exponent)) => format!("{}e{exponent}", trimmed(mantissa.into())),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn machine(folder: &Path) -> Index {
        std::fs::create_dir_all(folder.join("validate/water")).unwrap();
        std::fs::create_dir_all(folder.join("bench")).unwrap();
        let rows = r#"[
            {"quantity": "p", "value": 9917.1, "reference": 9810, "error": 0.011, "limit": 0.02, "passed": true, "commit": "abc"},
            {"quantity": "u | v", "value": 0.3, "reference": 0, "error": 0.3, "limit": 0.2, "passed": false, "commit": "abc"}
        ]"#;
        std::fs::write(folder.join("validate/water/still.json"), rows).unwrap();
        let rows = r#"[{"kind": "mrt", "grid": 64, "storage": "f32", "mlups": 43.25, "left_out": null, "commit": "abc"}]"#;
        std::fs::write(folder.join("bench/all.json"), rows).unwrap();
        Index {
            machine: "a GPU".into(),
            folder: folder.into(),
            ..Index::default()
        }
    }

    #[test]
    fn tables_stand_between_their_marks_and_show_what_was_missed() {
        let text = "before\n<!-- records: validate water/still -->\nold\n<!-- end of records -->\nafter\n\
            <!-- records: bench all -->\n<!-- end of records -->\n";
        let folder = tempfile::tempdir().unwrap();
        let machine = [machine(folder.path())];
        let rendered = render(text, &machine).unwrap();
        for line in [
            "before",
            "| `water/still`: hydrostatic pressure of water at rest | 1 of 2 | u \\| v | 0.3, **missed** | 0.3 | 0.2 | abc |",
            "|  |  | p | 9917, reference 9810 | 0.011 | 0.02 | abc |",
            "| mrt | 64 | f32 | 43.25 | – | abc |",
            "*a GPU.*",
            "after",
        ] {
            assert!(
                rendered.lines().any(|found| found == line),
                "{line}\n{rendered}"
            );
        }
        assert!(!rendered.contains("old"));
        assert_eq!(render(&rendered, &machine).unwrap(), rendered);
    }

    #[test]
    fn marks_without_an_end_or_a_table_are_refused() {
        assert!(render("<!-- records: validate water/* -->\n", &[]).is_err());
        let unknown = "<!-- records: everything -->\n<!-- end of records -->\n";
        assert!(render(unknown, &[Index::default()]).is_err());
    }
}
