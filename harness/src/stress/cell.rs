//! One cell of a map, as it stands in the files, and how its run ended.

use riprap::Error;
use serde::Serialize;
use std::{fmt, time::Instant};

/// How a run ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// It came to its end, and nothing in it contradicts physics.
    Ended,
    /// It came to its end with a number that no flow and no block can have.
    Unphysical,
    /// It came to its end and what was measured lies beyond the limit of the map.
    OverLimit,
    /// The library ended it with this error, the name of one of [`Error`].
    Error(String),
    /// The library ended it with this error, whose message does not name what it should.
    Unclear(String),
}

impl Outcome {
    /// Of an error: what is none of the library's keeps its first words.
    pub fn of(error: &anyhow::Error) -> Self {
        Self::Error(match error.downcast_ref::<Error>() {
            Some(error) => variant(error),
            None => error.to_string(),
        })
    }

    /// Whether the run came to its end as it should.
    pub fn is_good(&self) -> bool {
        *self == Self::Ended
    }

    /// Whether somebody must mend something: a message, or what the map measures.
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

/// Name of an error's variant: its debug form begins with it.
fn variant(error: &Error) -> String {
    let text = format!("{error:?}");
    let end = text.find([' ', '(', '{']).unwrap_or(text.len());
    text[..end].to_owned()
}

/// Columns of the table, in the order of [`Cell::row`].
pub const COLUMNS: &str = "map,panel,y,x,outcome,value,quantity,steps,warned,agrees,seconds,detail";

/// What one run of a map found.
#[derive(Clone, Debug, Serialize)]
pub struct Cell {
    /// Name of the map.
    pub map: String,
    /// Which of its panels: a method, or empty.
    pub panel: String,
    /// Place along the vertical axis.
    pub y: String,
    /// Place along the horizontal axis.
    pub x: String,
    /// How the run ended, [`Outcome`] in words.
    #[serde(serialize_with = "word")]
    pub outcome: Outcome,
    /// What was measured, if the run came so far.
    pub value: Option<f64>,
    /// What that is.
    pub quantity: String,
    /// Steps done.
    pub steps: u64,
    /// What the library said before the run: empty, `warned` or `refused`, with the keys.
    pub warned: String,
    /// Whether that fits what came, where the map judges it.
    pub agrees: Option<bool>,
    /// Time that it took, s.
    pub seconds: f64,
    /// The whole message, or more numbers.
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

    /// The cell after `follow` has run, with the time that it took.
    ///
    /// # Errors
    /// What is none of the library's errors: that is no finding.
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

    /// Ends it with what ended its run.
    ///
    /// # Errors
    /// What is none of the library's errors: that is no finding.
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

    /// As a row of comma-separated values, without its end.
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

    /// The few letters that fit into a square of a picture.
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

/// A field of a table: in quotes where it has to be (RFC 4180).
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
