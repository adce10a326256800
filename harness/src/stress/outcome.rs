//! How the run of a cell of a map ended.

use riprap::Error;
use std::fmt;

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

#[cfg(test)]
mod tests {
    use super::*;
    use anyhow::Context;

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
