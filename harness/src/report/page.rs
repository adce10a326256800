//! The report as a self-contained page: `report.html`.

use super::{
    Report,
    class::{Class, Reference},
    finding::{Choice, Finding},
    row::Row,
};
use crate::{picture::Measure, print::percent};
use anyhow::Result;
use std::fmt::Write;

const STYLE: &str = "body{font:16px/1.45 sans-serif;color:#222;max-width:1240px;margin:2em auto;padding:0 1em}\
    table{border-collapse:collapse;font-size:14px;margin:.6em 0}\
    td,th{padding:.15em .7em;border-bottom:1px solid #ddd;text-align:right}\
    td.l,th.l{text-align:left}tr.d td{font-weight:600}\
    h2{margin-top:2em}summary{cursor:pointer;color:#06c}figure{display:flex;margin:0}svg{width:50%;height:auto}\
    td.yes{color:#070}td.no{color:#b00}";

/// Explanation of the names of settings.
const SETTINGS: &str = "<p>Settings. <b>default</b>: what the library chooses (Hermite moments, product \
    equilibrium, f32, Λ = 3/16 next to walls and 1/10 next to blocks only, holdych, an exchange each step). The others \
    differ from it in one thing: <b>bgk</b>, <b>suga</b>: the collision; <b>order 2</b>: the equilibrium; \
    <b>Λ = 3/16</b>: that of the odd moments in every cell; <b>16-bit</b>: the storage; <b>noble</b>, \
    <b>superposition</b>: the operator of cells with a block; <b>interval n</b>: fluid and blocks are coupled every n \
    steps. Free water: <b>delta</b> (the default) and <b>mueller</b>.</p>\n";

/// The page of a report, with the classes that have run.
pub fn page(report: &Report, classes: &[Class]) -> Result<String> {
    let mut html = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
         <title>riprap: error against run time</title>\n<style>{STYLE}</style></head><body>\n\
         <h1>riprap: error against run time</h1>\n{}{SETTINGS}",
        head(report)
    );
    for class in classes {
        let rows = report.of(class.name);
        if !rows.is_empty() {
            html += &section(report, class, &rows)?;
        }
    }
    html += &findings(report, classes);
    Ok(html + "</body></html>\n")
}

fn head(report: &Report) -> String {
    let machine = &report.machine;
    format!(
        "<p>Measured on <b>{}</b> ({}, {}), {} cores, with riprap {}{}, {}; the {} form.</p>\n<p>Run time is {}. {} \
         An update is one of a cell or of a particle in a step: their number does not depend on the machine. The \
         numbers are in report.csv and report.json.</p>\n",
        escape(&machine.adapter),
        escape(&machine.backend),
        escape(&machine.driver),
        machine.cores,
        machine.version,
        machine
            .commit
            .as_ref()
            .map_or(String::new(), |c| format!(", commit {}", escape(c))),
        machine.date,
        if report.full { "full" } else { "short" },
        report.time.says(),
        escape(&report.noise_says()),
    )
}

fn section(report: &Report, class: &Class, rows: &[&Row]) -> Result<String> {
    let mut html = format!(
        "<h2 id=\"{}\">{}</h2>\n<p>{}; resolution: {}.{}</p>\n",
        class.name,
        escape(class.title),
        escape(&capital(class.error)),
        class.resolution,
        reference(class, rows)
    );
    let updates = Measure::logarithmic(&format!("{} updates", class.update), "");
    let charts = [
        report.chart_of_time(class),
        report.chart(class, updates, |row| row.updates as f64),
    ];
    html += "<figure>\n";
    for chart in charts {
        html += &chart.svg()?;
    }
    html += "</figure>\n";
    html += "<details><summary>table</summary><table><tr><th class=\"l\">setting</th>";
    for name in [
        "resolution",
        "τ",
        "y⁺",
        "value",
        "reference",
        "error",
        "updates",
        "CPU s",
        "wall s",
    ] {
        let _ = write!(html, "<th>{name}</th>");
    }
    html += "<th class=\"l\"></th></tr>\n";
    for row in rows {
        let class = if row.default { " class=\"d\"" } else { "" };
        let _ = writeln!(
            html,
            "<tr{class}><td class=\"l\">{}</td><td>{:.1}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>\
             <td>{:.2e}</td><td>{:.2}</td><td>{:.2}</td><td class=\"l\">{}</td></tr>",
            escape(&row.setting),
            row.resolution,
            number(row.tau, 3),
            number(row.y_plus, 2),
            number(row.value, 5),
            number(row.reference, 5),
            row.error.map_or("–".into(), percent),
            row.updates as f64,
            row.cpu_seconds,
            row.wall_seconds,
            escape(&row.note)
        );
    }
    Ok(html + "</table></details>\n")
}

/// Remarks on the reference.
fn reference(class: &Class, rows: &[&Row]) -> String {
    let uncertainty = rows.iter().map(|row| row.uncertainty).fold(0.0, f64::max);
    match class.reference {
        Reference::Limit => format!(
            " The limit is uncertain by {}: smaller errors are drawn and counted as this value.",
            percent(uncertainty)
        ),
        Reference::Recorded(_) => format!(
            " The limit was recorded on finer grids than these. It is uncertain by {}: smaller errors are drawn and \
             counted as this value.",
            percent(uncertainty)
        ),
        Reference::Known(..) if uncertainty > 0.0 => {
            format!(" The reference has digits for {}.", percent(uncertainty))
        }
        _ => String::new(),
    }
}

fn findings(report: &Report, classes: &[Class]) -> String {
    let same: Vec<String> = report
        .costs()
        .iter()
        .filter_map(|cost| report.findings.iter().find(|finding| finding.cost == *cost))
        .map(|finding| format!("{:.2} times the least {}", finding.same, finding.cost))
        .collect();
    let mut html = format!(
        "<h2 id=\"findings\">What the data say</h2>\n<p>The cheapest setting that reaches an error, on its coarsest grid \
         from which all finer grids that it ran on reach the error too, compared with the cost of the default. The default \
         follows from the data if it costs at most {}, which is within noise. “Not reached”: by none of the runs above; finer \
         grids may.</p>\n<table><tr><th class=\"l\">class</th><th>error</th>",
        same.join(" and ")
    );
    for cost in report.costs() {
        let _ = write!(
            html,
            "<th class=\"l\">cheapest by {cost}</th><th class=\"l\">default</th><th>ratio</th>"
        );
    }
    html += "<th>default follows</th></tr>\n";
    for class in classes {
        for target in super::finding::TARGETS {
            let found: Vec<&Finding> = report
                .findings
                .iter()
                .filter(|finding| finding.class == class.name && finding.target == target)
                .collect();
            if found.is_empty() {
                continue;
            }
            let _ = write!(
                html,
                "<tr><td class=\"l\"><a href=\"#{}\">{}</a></td><td>{}</td>",
                class.name,
                class.name,
                percent(target)
            );
            for finding in &found {
                let _ = write!(
                    html,
                    "<td class=\"l\">{}</td><td class=\"l\">{}</td><td>{}</td>",
                    choice(finding.cheapest.as_ref(), finding.cost),
                    choice(finding.default.as_ref(), finding.cost),
                    finding.ratio().map_or("–".into(), |r| format!("{r:.2}"))
                );
            }
            let verdicts: Option<Vec<bool>> = found.iter().map(|f| f.follows()).collect();
            html += match verdicts {
                None => "<td>–</td>",
                Some(all) if all.iter().all(|follows| *follows) => "<td class=\"yes\">yes</td>",
                Some(_) => "<td class=\"no\">no</td>",
            };
            html += "</tr>\n";
        }
    }
    let _ = write!(
        html,
        "</table>\n<p><b>{}</b></p>\n",
        escape(&report.verdict())
    );
    html
}

fn choice(choice: Option<&Choice>, cost: &str) -> String {
    choice.map_or("not reached".into(), |choice| {
        let spent = match cost {
            "updates" => format!("{:.1e}", choice.cost),
            _ => format!("{:.2} s", choice.cost),
        };
        format!(
            "{} on {:.1}: {spent} ({})",
            escape(&choice.setting),
            choice.resolution,
            percent(choice.error)
        )
    })
}

fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or("–".into(), |value| match value.abs() {
        v if v != 0.0 && v < 1e-3 => format!("{value:.2e}"),
        _ => format!("{value:.digits$}"),
    })
}

fn capital(text: &str) -> String {
    let mut chars = text.chars();
    let first = chars.next().map(|c| c.to_uppercase().to_string());
    first.unwrap_or_default() + chars.as_str()
}

/// Escapes text for HTML, SVG and their attributes.
pub fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped += "&amp;",
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '"' => escaped += "&quot;",
            c => escaped.push(c),
        }
    }
    escaped
}
