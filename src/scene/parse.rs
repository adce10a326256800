//! Parses scenes from TOML text; errors give the position and a remedy.

use std::ops::Range;
use std::path::Path;

use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

use super::Scene;
use super::renamed::renamed_keys;
use super::{series_files, tagged};
use crate::error::{Error, Place, Result};

/// Similarity (Jaro–Winkler, 0 to 1) from which one word counts as a misspelling of the other: `viscocity` and
/// `viscosity` have 0.97, unrelated keys of the format stay below 0.7.
const ALIKE: f64 = 0.75;

impl Scene {
    /// Reads and checks the scene in the TOML file at `path`.
    ///
    /// # Errors
    /// If the file cannot be read, is not TOML, does not follow the format, or contradicts
    /// itself.
    pub fn from_file(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let text = std::fs::read_to_string(path).map_err(|e| {
            let remedy = match e.kind() {
                std::io::ErrorKind::InvalidData => "save it as UTF-8",
                _ => "check the path",
            };
            Error::file(path, format!("cannot read the scene: {e}; {remedy}"))
        })?;
        let dir = path.parent().unwrap_or(Path::new(""));
        Self::from_toml(&text, dir, &path.display().to_string())
    }

    /// Reads and checks the scene in `text`. Paths of meshes are relative to `dir`; `place` names the text in
    /// messages, and its stem is the default title.
    ///
    /// # Errors
    /// If the text is not TOML, does not follow the format, or contradicts itself.
    pub fn from_toml(text: &str, dir: &Path, place: &str) -> Result<Self> {
        let mut scene = deserialize(text, dir).map_err(|refusal| refusal.at(text, place))?;
        dir.clone_into(&mut scene.dir);
        if scene.title.is_empty() {
            let stem = Path::new(place).file_stem();
            scene.title = stem.map_or_else(|| "scene".into(), |s| s.to_string_lossy().into());
        }
        scene.check().map_err(|e| locate(e, text, place))?;
        Ok(scene)
    }

    /// Adds the line and column of the key to an `error` about a key of the scene in `text`, or about an argument made from
    /// one; `place` names the text. Other errors are returned unchanged.
    pub fn locate(error: Error, text: &str, place: &str) -> Error {
        locate(error, text, place)
    }
}

/// Error for a text that does not follow the format.
pub(super) struct Refusal {
    /// Range of bytes in the text.
    pub span: Option<Range<usize>>,
    /// Path of keys from the scene to the error, without the indices of lists.
    pub key: String,
    /// The problem and a remedy.
    pub message: String,
}

/// The scene in `text`, not checked yet.
fn deserialize(text: &str, dir: &Path) -> Result<Scene, Refusal> {
    let refused = |error| Refusal::of(error, text);
    let mut document = DeTable::parse(text).map_err(refused)?;
    series_files::insert(document.get_mut(), dir)?;
    let mut document = Spanned::new(document.span(), DeValue::Table(document.into_inner()));
    tagged::tag(&mut document)?;
    Scene::deserialize(ValueDeserializer::from(document)).map_err(|error| {
        let no_word = error.message() == "wanted string or table";
        let refusal = refused(error);
        match no_word {
            true => refusal.with_words(text, dir),
            false => refusal,
        }
    })
}

impl Refusal {
    /// Prepends the table `key` to the path of keys.
    pub fn below(self, key: &str) -> Self {
        let key = match self.key.as_str() {
            "" => key.to_owned(),
            inner => format!("{key}.{inner}"),
        };
        Self { key, ..self }
    }

    /// Lists the words that are possible where `text` has a value of another type: those that an empty word there is refused for.
    fn with_words(self, text: &str, dir: &Path) -> Self {
        let mut empty = text.to_owned();
        if let Some(span) = self.span.clone() {
            empty.replace_range(span, "\"\"");
        }
        let words = match deserialize(&empty, dir) {
            Err(Self { message, .. }) => message.replace("there is no word `` here; ", ""),
            Ok(_) => String::new(),
        };
        let message = format!("is not a word in quotes; {words}");
        Self { message, ..self }
    }

    fn of(mut error: toml::de::Error, text: &str) -> Self {
        // Without its input the error prints the path of keys that it concerns.
        error.set_input(None);
        let printed = error.to_string();
        let keys = printed
            .trim_end()
            .rsplit_once("\nin `")
            .and_then(|(_, keys)| keys.strip_suffix('`'));
        // In the text, the keys of a kind are keys of its table.
        let key = keys.unwrap_or_default().replace(".kind.", ".");
        let found = error.span().and_then(|span| text.get(span));
        let message = match (error.message(), found) {
            ("duplicate key", Some(key)) => {
                format!("`{key}` occurs twice in its table; keep one of the two")
            }
            (message, _) => explain(message),
        };
        Self {
            span: error.span(),
            key,
            message,
        }
    }

    /// Converts to an error with line and column in `text`; `place` names the text.
    fn at(self, text: &str, place: &str) -> Error {
        let Self { span, key, message } = self;
        let at = |position| {
            Some(Place {
                file: place.to_owned(),
                position,
            })
        };
        // Text that is not TOML has no keys; its own error is returned instead.
        match renamed_keys(text, place).unwrap_or_default().first() {
            Some(first) => Error::Scene {
                place: at(Some([first.line, first.column])),
                key: first.key.old.to_owned(),
                message: format!("{first}; `riprap migrate {place}` rewrites all old keys"),
            },
            None => Error::Scene {
                place: at(span.map(|span| position(text, span.start))),
                key,
                message,
            },
        }
    }
}

/// Adds the line of the key that the error of a check names.
fn locate(error: Error, text: &str, place: &str) -> Error {
    match error {
        Error::Scene {
            place: None,
            key,
            message,
        }
        | Error::Argument { what: key, message } => Error::Scene {
            place: Some(Place {
                file: place.to_owned(),
                position: find(text, &key),
            }),
            key,
            message,
        },
        Error::Overlaps { mut pairs } => {
            for pair in &mut pairs {
                for block in [&mut pair.first, &mut pair.second] {
                    let name = block
                        .split_once(" (")
                        .map(|(_, name)| name.trim_end_matches(')'));
                    if let Some([line, _]) = name.and_then(|name| find_block(text, name)) {
                        *block = format!("{block} of {place}:{line}");
                    }
                }
            }
            Error::Overlaps { pairs }
        }
        other => other,
    }
}

/// Line and column of the value at the path `key` such as `probes[1].at`, or of the nearest
/// table around it that is written in the text.
fn find(text: &str, key: &str) -> Option<[usize; 2]> {
    if let Some(name) = key.strip_prefix("block ") {
        return find_block(text, name);
    }
    let document = DeTable::parse(text).ok()?;
    let mut steps = key.split(['.', '[']);
    let mut found = document.get_ref().get(steps.next()?)?;
    for step in steps {
        let value = found.get_ref();
        let next = match step.strip_suffix(']') {
            Some(index) => index.parse::<usize>().ok().and_then(|i| value.get(i)),
            None => value.get(step),
        };
        let Some(next) = next else { break };
        found = next;
    }
    Some(position(text, found.span().start))
}

/// Line and column of the table that makes the block `name`, or several blocks including it, such as `name_3` of `name`.
fn find_block(text: &str, name: &str) -> Option<[usize; 2]> {
    let document = DeTable::parse(text).ok()?;
    let tables = ["blocks", "solids", "rock_masses"].into_iter();
    let tables = tables.filter_map(|key| document.get_ref().get(key)?.get_ref().as_array());
    let mut tables = tables.flatten();
    let makes = |own: &str| {
        let rest = name.strip_prefix(own);
        let number = |rest: &str| {
            rest.strip_prefix('_')
                .is_some_and(|n| n.parse::<u64>().is_ok())
        };
        rest.is_some_and(|rest| rest.is_empty() || number(rest))
    };
    let found = tables.find(|table| {
        let own = table
            .get_ref()
            .get("name")
            .and_then(|own| own.get_ref().as_str());
        own.is_some_and(makes)
    })?;
    Some(position(text, found.span().start))
}

/// Line and column of the byte `offset`, counted from 1.
pub(super) fn position(text: &str, offset: usize) -> [usize; 2] {
    let before = text.get(..offset).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    [
        before.matches('\n').count() + 1,
        before[line_start..].chars().count() + 1,
    ]
}

/// Message for an unknown key or other word (`what`), with the most similar known one.
pub(super) fn unknown(what: &str, wrong: &str, possible: &[&str]) -> String {
    let best = possible
        .iter()
        .map(|word| (strsim::jaro_winkler(wrong, word), word))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .filter(|(alike, _)| *alike >= ALIKE);
    let guess = best.map_or(String::new(), |(_, word)| {
        format!(" did you mean `{word}`?")
    });
    format!(
        "there is no {what} `{wrong}` here;{guess} possible are {}",
        possible.join(", ")
    )
}

/// Translates a message of serde to the terms of the format.
fn explain(message: &str) -> String {
    let words: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    for (what, start) in [("key", "unknown field"), ("word", "unknown variant")] {
        if let (true, Some((wrong, possible))) = (message.starts_with(start), words.split_first()) {
            return unknown(what, wrong, possible);
        }
    }
    if let (true, Some(key)) = (message.starts_with("missing field"), words.first()) {
        return format!("the key `{key}` is missing; add it");
    }
    let length = message.trim_end().strip_prefix("invalid length ");
    if let Some((has, wants)) = length.and_then(|l| l.split_once(", expected an array of length "))
    {
        return format!("has {has} values; give {wants} between the brackets");
    }
    if message.starts_with("invalid type: map, expected a sequence") {
        return "is a list of tables; write each of them below its key in double brackets, as [[materials]]".into();
    }
    message
        .trim_end()
        .replace("expected f64", "expected a number")
        .replace(
            "expected u32",
            "expected a whole number from 0 to 4294967295",
        )
        .replace("expected u64", "expected a whole number from 0")
}
