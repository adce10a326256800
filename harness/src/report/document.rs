//! Contents of a report: rows, findings and noise, in words, as JSON and as pictures.

use super::{
    class::Class,
    computed,
    finding::{Finding, SAME, TARGETS},
    page,
    row::{Cost, Row},
};
use crate::{
    bench::Machine,
    picture::{Chart, Curve, Mark, Measure, extremes},
    print::percent,
    validate::CaseContext,
};
use riprap::output::replace;
use serde::Serialize;
use std::path::Path;

/// Which time counts as run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Time {
    /// CPU time of all threads: a busy machine distorts it least.
    Cpu,
    /// Wall time.
    Wall,
}

impl Time {
    pub(super) fn of(self) -> Cost {
        match self {
            Self::Cpu => |row| row.cpu_seconds,
            Self::Wall => |row| row.wall_seconds,
        }
    }

    pub(super) fn says(self) -> &'static str {
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
    /// Run times of both runs, s.
    pub seconds: [f64; 2],
}

impl Repeat {
    /// Difference of the two times over the smaller one.
    fn apart(&self) -> f64 {
        let [a, b] = self.seconds;
        (a - b).abs() / a.min(b)
    }
}

/// All measurements.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Machine and time of the measurement.
    #[serde(flatten)]
    pub machine: Machine,
    /// Whether this is the full form.
    pub full: bool,
    /// Which time counts as run time.
    pub time: Time,
    /// Runs that were done twice.
    pub repeats: Vec<Repeat>,
    /// The rows.
    pub rows: Vec<Row>,
    /// Conclusions from the rows.
    pub findings: Vec<Finding>,
}

impl Report {
    /// The rows of a class.
    pub(super) fn of(&self, class: &str) -> Vec<&Row> {
        self.rows.iter().filter(|row| row.class == class).collect()
    }

    /// Repeats the longest of the short runs with the defaults of a class.
    pub(super) fn repeat(&self, context: &CaseContext, class: &Class) -> Option<Repeat> {
        /// Longest run that is done twice, s.
        const SHORT: f64 = 2.0;
        let time = self.time.of();
        let rows = self.of(class.name);
        let point_of = |row: &Row| class.points.iter().find(|point| row.is_of(point));
        let (row, point) = rows
            .iter()
            .filter_map(|row| Some((row, point_of(row)?)))
            .filter(|(row, point)| point.default && row.error.is_some() && time(row) < SHORT)
            .max_by(|(a, _), (b, _)| time(a).total_cmp(&time(b)))?;
        let again = computed(context, class, point);
        Some(Repeat {
            class: class.name.into(),
            resolution: row.resolution,
            seconds: [time(row), time(&again)],
        })
    }

    /// Describes how much run times differ from run to run.
    pub(super) fn noise_says(&self) -> String {
        let mut all: Vec<f64> = self.repeats.iter().map(Repeat::apart).collect();
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
    pub(super) fn costs(&self) -> [&'static str; 2] {
        ["run time", "updates"]
    }

    /// Finds the cheapest settings.
    pub(super) fn conclude(&mut self, classes: &[Class]) {
        let [time, updates] = self.costs();
        let all: [Cost; 2] = [self.time.of(), |row| row.updates as f64];
        let findings = classes.iter().flat_map(|class| {
            let rows = self.of(class.name);
            // The noise of other classes does not apply; updates are counted and have none.
            let own = self.repeats.iter().filter(|one| one.class == class.name);
            let noise = own.map(Repeat::apart).fold(0.0, f64::max);
            let costs = [
                (time, all[0], SAME.max(1.0 + noise)),
                (updates, all[1], SAME),
            ];
            let targets = TARGETS
                .iter()
                .flat_map(|target| costs.map(|cost| (*target, cost)));
            let targets = targets.filter(|_| !rows.is_empty());
            let found = targets.map(|(target, cost)| Finding::of(class.name, &rows, target, cost));
            found.collect::<Vec<_>>()
        });
        self.findings = findings.collect();
    }

    /// Whether the defaults follow from the findings, in words.
    pub(super) fn verdict(&self) -> String {
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
            "The defaults are the cheapest, or cost as little within noise, in {} of {} questions",
            reached.len() - others.len(),
            reached.len()
        );
        if !others.is_empty() {
            text += &format!("; not for {}", others.join("; "));
        }
        text + "."
    }

    /// Error of a class against a cost: a curve for each setting, and the target errors.
    pub(super) fn chart(&self, class: &Class, x: Measure, cost: Cost) -> Chart {
        let rows = self.of(class.name);
        let mut curves: Vec<Curve> = Vec::new();
        for row in &rows {
            let at = curves.iter().position(|curve| curve.name == row.setting);
            let at = at.unwrap_or_else(|| {
                curves.push(Curve {
                    name: row.setting.clone(),
                    points: Vec::new(),
                    mark: Mark::LinePoints,
                });
                curves.len() - 1
            });
            // Errors far beyond the method's range are not drawn.
            if let Some(error) = row.certain_error().filter(|error| *error < 10.0) {
                curves[at].points.push([cost(row), 100.0 * error]);
            }
        }
        for curve in &mut curves {
            curve.points.sort_by(|a, b| a[0].total_cmp(&b[0]));
            if curve.points.is_empty() {
                curve.name += " (no result)";
            }
        }
        let known = rows.iter().filter(|row| row.error.is_some());
        let costs = known.map(|row| cost(row)).filter(|cost| *cost > 0.0);
        let ends = extremes(costs);
        curves.extend(TARGETS.map(|target| Curve {
            name: percent(target),
            points: ends.map(|cost| [cost, 100.0 * target]).into(),
            mark: Mark::Dashed,
        }));
        let y = Measure::logarithmic("error", "%");
        Chart::profile(class.title, x, y, curves)
    }

    /// The chart of a class over run time.
    pub(super) fn chart_of_time(&self, class: &Class) -> Chart {
        let x = match self.time {
            Time::Cpu => Measure::logarithmic("CPU time of all threads", "s"),
            Time::Wall => Measure::logarithmic("run time", "s"),
        };
        self.chart(class, x, self.time.of())
    }

    /// Writes the page and the JSON.
    pub(super) fn write(&self, folder: &Path, classes: &[Class]) -> anyhow::Result<()> {
        let json = serde_json::to_string_pretty(self)? + "\n";
        let html = page::page(self, classes)?;
        for (name, text) in [("report.json", json), ("report.html", html)] {
            replace(&folder.join(name), |file| file.write_all(text.as_bytes()))?;
        }
        Ok(())
    }
}
