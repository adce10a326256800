//! Result of a case: one number with its reference, its error, its limit and its cost.

use kit::clock::Spent;
use riprap::lattice::{Collision, Equilibrium, Force, Setup, Storage};
use serde::Serialize;
use std::time::Instant;

/// One number that a case measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Record {
    /// Name of the case, such as `cavity/re100`.
    pub case: String,
    /// Setup of the run, in one line.
    pub setup: String,
    /// Fluid and solid cells of the domain; for dry rock, the number of blocks.
    pub cells: u64,
    /// Steps done.
    pub steps: u64,
    /// Time on the device, readbacks included, or on the host, s.
    pub seconds: f64,
    /// Name of `value`, with its unit if it has one.
    pub quantity: String,
    /// Value found.
    pub value: f64,
    /// Expected value, if known.
    pub reference: Option<f64>,
    /// Deviation from the reference, in the measure of `limit`.
    pub error: Option<f64>,
    /// Largest error that passes; `None` if the number is only reported.
    pub limit: Option<f64>,
    /// Whether the error is within the limit.
    pub passed: bool,
}

/// Setup and cost of a run, shared by all its records.
#[derive(Clone, Debug, Default)]
pub struct Trial {
    /// Setup of the run, in one line.
    pub setup: String,
    /// Cells of the domain.
    pub cells: u64,
    /// Steps done.
    pub steps: u64,
    /// Time on the device, s.
    pub seconds: f64,
    /// Time of the steps alone, if measured.
    pub stepping: Spent,
}

impl Trial {
    /// A trial run on the host since `begin`.
    pub fn since(begin: Instant, setup: impl Into<String>, cells: u64, steps: u64) -> Self {
        Self {
            setup: setup.into(),
            cells,
            steps,
            seconds: begin.elapsed().as_secs_f64(),
            ..Self::default()
        }
    }

    /// Reports a number without reference and limit.
    pub fn report(&self, quantity: impl Into<String>, value: f64) -> Record {
        Record {
            case: String::new(),
            setup: self.setup.clone(),
            cells: self.cells,
            steps: self.steps,
            seconds: self.seconds,
            quantity: quantity.into(),
            value,
            reference: None,
            error: None,
            limit: None,
            passed: true,
        }
    }

    /// Passes if |value/reference − 1| ≤ limit; without a limit the error is reported.
    pub fn relative(
        &self,
        quantity: impl Into<String>,
        value: f64,
        reference: f64,
        limit: impl Into<Option<f64>>,
    ) -> Record {
        let error = (value / reference - 1.0).abs();
        let record = self.report(quantity, value);
        record.judged(reference, error, limit.into())
    }

    /// Passes if |value − reference| ≤ limit.
    pub fn absolute(
        &self,
        quantity: impl Into<String>,
        value: f64,
        reference: f64,
        limit: f64,
    ) -> Record {
        let error = (value - reference).abs();
        let record = self.report(quantity, value);
        record.judged(reference, error, Some(limit))
    }

    /// For a value that is an error itself: passes if value ≤ limit; without a limit it is reported.
    pub fn at_most(
        &self,
        quantity: impl Into<String>,
        value: f64,
        limit: impl Into<Option<f64>>,
    ) -> Record {
        let record = self.report(quantity, value);
        match limit.into() {
            Some(limit) => record.judged(0.0, value, Some(limit)),
            None => record,
        }
    }

    /// Passes if value ≥ bound; the error is the shortfall.
    pub fn at_least(&self, quantity: impl Into<String>, value: f64, bound: f64) -> Record {
        // `f64::max` would turn NaN into 0.
        let missing = if value >= bound { 0.0 } else { bound - value };
        let record = self.report(quantity, value);
        record.judged(bound, missing, Some(0.0))
    }
}

impl Record {
    fn judged(self, reference: f64, error: f64, limit: Option<f64>) -> Self {
        Self {
            reference: Some(reference),
            error: Some(error),
            limit,
            // A comparison with NaN is false: a NaN does not pass.
            passed: limit.is_none_or(|limit| error <= limit),
            ..self
        }
    }
}

/// Name of a collision operator, as in scene files.
pub fn collision(collision: Collision) -> &'static str {
    match collision {
        Collision::Bgk => "bgk",
        Collision::Hermite => "hermite",
        Collision::Suga => "suga",
    }
}

/// Name of an equilibrium in records.
pub fn equilibrium(equilibrium: Equilibrium) -> &'static str {
    match equilibrium {
        Equilibrium::Product => "product",
        Equilibrium::SecondOrder => "order 2",
    }
}

/// Describes a setup in one line: cells, relaxation time, and the settings that differ from the defaults.
pub fn describe(setup: &Setup) -> String {
    let [x, y, z] = setup.cells;
    let collision = collision(setup.collision);
    let equilibrium = equilibrium(setup.equilibrium);
    let mut text = format!("{x}x{y}x{z} τ {:.5} {collision} {equilibrium}", setup.tau());
    if let Some(constant) = setup.wale {
        text += &format!(" wale {constant}");
    }
    if let Some(model) = setup.wall_model {
        text += &format!(" walls {model:?}");
    }
    if let Some(lambda) = setup.lambda {
        text += &format!(" Λ {lambda}");
    }
    text += match setup.force {
        Force::None => "",
        Force::Constant(_) => " force",
        Force::Field(_) => " force field",
    };
    text += match setup.storage {
        Storage::F32 => " f32",
        Storage::F16 => " 16-bit",
    };
    text + &format!(" lanes {}", setup.lanes)
}

/// Column heads for [`row`].
pub fn header() -> String {
    format!(
        "{:4} {:44} {:>13} {:>13} {:>10} {:>10} {:>8} {:>7}  setup",
        "", "quantity", "value", "reference", "error", "limit", "steps", "s"
    )
}

/// Formats a record as a line of the table.
pub fn row(record: &Record) -> String {
    let small = |value: Option<f64>| value.map_or(String::from("-"), |v| format!("{v:.2e}"));
    let verdict = match (record.passed, record.limit) {
        (false, _) => "FAIL",
        (true, Some(_)) => "ok",
        (true, None) => "info",
    };
    format!(
        "{verdict:4} {:44} {:>13} {:>13} {:>10} {:>10} {:>8} {:>7.1}  {}",
        record.quantity,
        number(record.value),
        record.reference.map_or(String::from("-"), number),
        small(record.error),
        small(record.limit),
        record.steps,
        record.seconds,
        record.setup,
    )
}

fn number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) {
        format!("{value:.6}")
    } else {
        format!("{value:.5e}")
    }
}
