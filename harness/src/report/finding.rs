//! Conclusions from the rows: the cheapest setting that reaches an error, compared with the cost of the default.

use super::row::{Cost, Row};
use serde::Serialize;

/// Target errors.
pub const TARGETS: [f64; 3] = [0.05, 0.01, 0.001];
/// Costs up to this ratio count as the same unless noise is larger: the additional cost of a grid finer by 6 %.
pub const SAME: f64 = 1.25;

/// A row that reaches an error.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Choice {
    /// Its setting.
    pub setting: String,
    /// Its resolution.
    pub resolution: f64,
    /// Its error.
    pub error: f64,
    /// Its cost, s or updates.
    pub cost: f64,
}

/// The result for a class, a target error and a cost.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// Class of scenes.
    pub class: String,
    /// The target error.
    pub target: f64,
    /// Name of the cost.
    pub cost: &'static str,
    /// Ratio of costs up to which they count as the same.
    pub same: f64,
    /// The cheapest setting, if one reaches it.
    pub cheapest: Option<Choice>,
    /// The cheapest with the defaults, if one reaches it.
    pub default: Option<Choice>,
}

impl Finding {
    /// Searches the rows of a class.
    pub fn of(
        class: &str,
        rows: &[&Row],
        target: f64,
        (name, cost, same): (&'static str, Cost, f64),
    ) -> Self {
        let reaching: Vec<&Row> = rows
            .iter()
            .copied()
            .filter(|row| reaches(row, rows, target))
            .collect();
        let least = |some: &dyn Fn(&Row) -> bool| {
            let some = reaching.iter().filter(|row| some(row));
            let row = some.min_by(|a, b| cost(a).total_cmp(&cost(b)))?;
            Some(Choice {
                setting: row.setting.clone(),
                resolution: row.resolution,
                error: row.certain_error()?,
                cost: cost(row),
            })
        };
        Self {
            class: class.into(),
            target,
            cost: name,
            same,
            cheapest: least(&|_| true),
            default: least(&|row| row.default),
        }
    }

    /// Cost of the defaults over the least cost, if both reach the error.
    pub fn ratio(&self) -> Option<f64> {
        Some(self.default.as_ref()?.cost / self.cheapest.as_ref()?.cost)
    }

    /// Whether the finding supports the defaults; `None` if nothing reaches the error.
    pub fn follows(&self) -> Option<bool> {
        self.cheapest.as_ref()?;
        Some(self.ratio().is_some_and(|ratio| ratio <= self.same))
    }
}

/// Whether a row and all finer ones of its setting have an error of at most `target`: a small error at a change of its sign is a
/// coincidence.
fn reaches(row: &Row, rows: &[&Row], target: f64) -> bool {
    let mut finer = rows
        .iter()
        .filter(|other| other.setting == row.setting && other.resolution >= row.resolution);
    finer.all(|other| other.certain_error().is_some_and(|error| error <= target))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(setting: &str, resolution: f64, error: Option<f64>, seconds: f64) -> Row {
        Row {
            setting: setting.into(),
            default: setting == "default",
            resolution,
            error,
            cpu_seconds: seconds,
            ..Row::default()
        }
    }

    fn find(rows: &[Row], target: f64) -> Finding {
        let rows: Vec<&Row> = rows.iter().collect();
        Finding::of("", &rows, target, ("s", |row| row.cpu_seconds, SAME))
    }

    #[test]
    fn the_cheapest_that_reaches_it_is_found() {
        let rows = [
            row("default", 8.0, Some(0.04), 1.0),
            row("default", 16.0, Some(0.009), 8.0),
            row("bgk", 8.0, Some(0.06), 0.5),
            row("bgk", 16.0, Some(0.008), 4.0),
        ];
        let loose = find(&rows, 0.05);
        assert_eq!(loose.cheapest, loose.default);
        assert_eq!((loose.ratio(), loose.follows()), (Some(1.0), Some(true)));
        let tight = find(&rows, 0.01);
        assert_eq!(tight.cheapest.as_ref().map(|c| c.cost), Some(4.0));
        assert_eq!((tight.ratio(), tight.follows()), (Some(2.0), Some(false)));
        let none = find(&rows, 0.001);
        assert_eq!((none.cheapest.clone(), none.follows()), (None, None));
    }

    #[test]
    fn an_error_that_grows_again_was_luck() {
        let rows = [
            row("default", 8.0, Some(0.001), 1.0),
            row("default", 16.0, Some(0.02), 8.0),
            row("default", 32.0, Some(0.004), 64.0),
        ];
        let found = find(&rows, 0.01).cheapest;
        assert_eq!(found.map(|choice| choice.resolution), Some(32.0));
    }

    #[test]
    fn a_finer_run_that_diverged_spoils_its_setting() {
        let rows = [
            row("suga", 8.0, Some(0.001), 1.0),
            row("suga", 16.0, None, 0.0),
            row("default", 8.0, Some(0.002), 2.0),
        ];
        let found = find(&rows, 0.01);
        assert_eq!(found.cheapest.map(|c| c.setting), Some("default".into()));
    }

    #[test]
    fn no_error_counts_below_the_uncertainty_of_its_reference() {
        let mut rows = [row("default", 8.0, Some(0.001), 1.0)];
        rows[0].uncertainty = 0.02;
        assert_eq!(find(&rows, 0.01).cheapest, None);
    }
}
