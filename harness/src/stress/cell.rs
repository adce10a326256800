//! One cell of a map, as stored in the files, and the outcome of its run.

use riprap::Error;
use serde::Serialize;
use std::{fmt, time::Instant};

/// How a run ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// It completed, and nothing in it contradicts physics.
    Ended,
    /// It completed with a number that no flow and no block can have.
    Unphysical,
    /// It completed, and the measured value exceeds the limit of the map.
    OverLimit,
    /// The library stopped it with this error, named after a variant of [`Error`].
    Error(String),
    /// The library stopped it with this error, whose message lacks what it should name.
    Unclear(String),
}

impl Outcome {
    /// The outcome of an error: the variant of a library error, or the message of any other.
    pub fn of(error: &anyhow::Error) -> Self {
        Self::Error(match error.downcast_ref::<Error>() {
            Some(error) => variant(error),
            None => error.to_string(),
        })
    }

    /// Whether the run completed as it should.
    pub fn is_good(&self) -> bool {
        *self == Self::Ended
    }

    /// Whether something must be fixed: a message, or what the map measures.
    pub fn is_defect(&self) -> bool {
        matches!(self, Self::Unclear(_) | Self::OverLimit)
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ended => write!(f, "ended"),
            Self::Unphysical => write!(f, "unphysical"),
            Self::OverLimit => write!(f, "over its limit"),
            Self::Error(name) => write!(f, "{name}"),
            Self::Unclear(name) => write!(f, "unclear {name}"),
        }
    }
}

/// Name of an error's variant, which begins its debug form.
fn variant(error: &Error) -> String {
    let text = format!("{error:?}");
    let end = text.find([' ', '(', '{']).unwrap_or(text.len());
    text[..end].to_owned()
}

/// Columns of the table, in the order of [`Cell::row`].
pub const COLUMNS: &str = "map,panel,y,x,outcome,value,quantity,steps,warned,agrees,seconds,detail";

/// Result of one run of a map.
#[derive(Clone, Debug, Serialize)]
pub struct Cell {
    /// Name of the map.
    pub map: String,
    /// Panel of the map: a method, or empty.
    pub panel: String,
    /// Position on the vertical axis.
    pub y: String,
    /// Position on the horizontal axis.
    pub x: String,
    /// The [`Outcome`] of the run, in words.
    #[serde(serialize_with = "word")]
    pub outcome: Outcome,
    /// Measured value, if the run got that far.
    pub value: Option<f64>,
    /// Name of the value.
    pub quantity: String,
    /// Steps done.
    pub steps: u64,
    /// Advice of the library before the run: empty, `warned` or `refused`, with the keys.
    pub warned: String,
    /// Whether the advice fits the outcome, if the map judges it.
    pub agrees: Option<bool>,
    /// Duration, s.
    pub seconds: f64,
    /// The full message, or more numbers.
    pub detail: String,
}

fn word<S: serde::Serializer>(outcome: &Outcome, to: S) -> Result<S::Ok, S::Error> {
    to.collect_str(outcome)
}

impl Cell {
    /// A cell that has not run yet.
    pub fn new(map: &str, panel: &str, y: String, x: String, quantity: &str) -> Self {
        Self {
            map: map.into(),
            panel: panel.into(),
            y,
            x,
            outcome: Outcome::Ended,
            value: None,
            quantity: quantity.into(),
            steps: 0,
            warned: String::new(),
            agrees: None,
            seconds: 0.0,
            detail: String::new(),
        }
    }

    /// Runs `follow` and returns the cell with its outcome and the time spent.
    pub fn run(
        mut self,
        follow: impl FnOnce(&mut Self) -> anyhow::Result<()>,
    ) -> anyhow::Result<Self> {
        let begin = Instant::now();
        let followed = follow(&mut self);
        self.end(followed)?;
        self.seconds = begin.elapsed().as_secs_f64();
        Ok(self)
    }

    /// Records the error that ended the run, if any. Errors that are not the library's are returned: they are not findings.
    pub fn end(&mut self, ended: anyhow::Result<()>) -> anyhow::Result<()> {
        let Err(error) = ended else { return Ok(()) };
        match error.downcast_ref::<Error>() {
            None => return Err(error),
            Some(Error::Diverged { step, .. }) => self.steps = *step,
            Some(_) => {}
        }
        self.outcome = Outcome::of(&error);
        self.detail = error.to_string();
        Ok(())
    }

    /// A row of comma-separated values, without the line end.
    pub fn row(&self) -> String {
        let number = |value: Option<f64>| value.map_or(String::new(), |v| format!("{v:e}"));
        [
            quoted(&self.map),
            quoted(&self.panel),
            quoted(&self.y),
            quoted(&self.x),
            quoted(&self.outcome.to_string()),
            number(self.value),
            quoted(&self.quantity),
            self.steps.to_string(),
            quoted(&self.warned),
            self.agrees
                .map_or(String::new(), |agrees| agrees.to_string()),
            format!("{:.2}", self.seconds),
            quoted(&self.detail),
        ]
        .join(",")
    }

    /// Short text that fits into a square of a picture.
    pub fn label(&self) -> String {
        let value = self.value.map(short);
        match &self.outcome {
            Outcome::Error(name) if name == "Diverged" => format!("@{}", self.steps),
            Outcome::Error(name) | Outcome::Unclear(name) => name.clone(),
            _ => value.unwrap_or_default(),
        }
    }
}

/// Three digits.
fn short(value: f64) -> String {
    if value == 0.0 || (0.01..1e4).contains(&value.abs()) {
        let text = format!("{value:.2}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        format!("{value:.0e}")
    }
}

/// A field of a table, in quotes if necessary (RFC 4180).
pub fn quoted(text: &str) -> String {
    match text.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use anyhow::Context;

    fn cell(outcome: Outcome, value: Option<f64>) -> Cell {
        let (y, x) = ("1e-4".into(), "0.1".into());
        Cell {
            outcome,
            value,
            steps: 312,
            agrees: Some(false),
            seconds: 1.5,
            detail: "it said \"no\"".into(),
            ..Cell::new("shear_layer", "bgk, order 2", y, x, "max|u| / U₀")
        }
    }

    #[test]
    fn rows_have_all_columns_and_quotes_where_they_must() {
        let row = cell(Outcome::Ended, Some(1.25)).row();
        assert_eq!(
            row,
            "shear_layer,\"bgk, order 2\",1e-4,0.1,ended,1.25e0,max|u| / U₀,312,,false,1.50,\"it said \"\"no\"\"\""
        );
        let plain = Cell {
            panel: "bgk".into(),
            detail: String::new(),
            ..cell(Outcome::Unphysical, None)
        };
        assert_eq!(plain.row().split(',').count(), COLUMNS.split(',').count());
    }

    #[test]
    fn labels_are_short() {
        assert_eq!(cell(Outcome::Ended, Some(1.0)).label(), "1");
        assert_eq!(cell(Outcome::Unphysical, Some(1.3456)).label(), "1.35");
        assert_eq!(cell(Outcome::Ended, Some(3.2e-9)).label(), "3e-9");
        let ended = |name: &str| cell(Outcome::Error(name.into()), None).label();
        assert_eq!(ended("Diverged"), "@312");
        assert_eq!(ended("TimeStep"), "TimeStep");
    }

    #[test]
    fn errors_of_the_library_are_called_by_their_names() {
        let lost = Error::DeviceLost("gone".into());
        assert_eq!(variant(&lost), "DeviceLost");
        let scene: anyhow::Error = Error::scene("domain", "is none").into();
        assert_eq!(Outcome::of(&scene), Outcome::Error("Scene".into()));
        let inside = Err::<(), _>(lost).context("in a cell").unwrap_err();
        assert_eq!(Outcome::of(&inside), Outcome::Error("DeviceLost".into()));
    }

    #[test]
    fn only_messages_and_limits_are_defects() {
        let diverged = Outcome::Error("Diverged".into());
        assert!(!diverged.is_defect() && !diverged.is_good());
        assert!(Outcome::Unclear("Diverged".into()).is_defect());
        assert!(Outcome::OverLimit.is_defect());
        assert!(!Outcome::Unphysical.is_defect() && Outcome::Ended.is_good());
    }
}
