//! Renamed keys of scenes: their table, and the migration of scenes that use old names.

use super::parse::position;
use crate::{Error, Result, error::Place};
use std::{fmt, ops::Range};
use toml::de::{DeTable, DeValue};

/// A renamed key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenamedKey {
    /// Tables around it from the outermost one, joined by dots; one name stands for all tables of an array. Empty for a
    /// key of the scene itself.
    pub table: &'static str,
    /// Its old name.
    pub old: &'static str,
    /// Its new name.
    pub new: &'static str,
}

/// All renamed keys of scenes.
pub const RENAMED_KEYS: &[RenamedKey] = &[RenamedKey {
    table: "rock",
    old: "search",
    new: "broadphase",
}];

/// An old key in the text of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Renaming {
    /// The key.
    pub key: RenamedKey,
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1.
    pub column: usize,
    /// Range of bytes of the key in the text.
    span: Range<usize>,
}

impl fmt::Display for Renaming {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let RenamedKey { table, old, new } = self.key;
        let dot = if table.is_empty() { "" } else { "." };
        write!(f, "the key `{table}{dot}{old}` is now `{table}{dot}{new}`")
    }
}

/// The old keys in the text of the scene `file`, in order of appearance.
///
/// # Errors
/// [`Error::Scene`] if the text is not TOML, or if a table has both an old key and the new one.
pub fn renamed_keys(text: &str, file: &str) -> Result<Vec<Renaming>> {
    let document = DeTable::parse(text).map_err(|error| {
        let start = error.span().map_or(0, |span| span.start);
        refused(file, position(text, start), "", error.message())
    })?;
    let mut found = Vec::new();
    for key in RENAMED_KEYS {
        let path: Vec<&str> = key
            .table
            .split('.')
            .filter(|step| !step.is_empty())
            .collect();
        collect((text, file), document.get_ref(), &path, key, &mut found)?;
    }
    found.sort_by_key(|renaming| renaming.span.start);
    Ok(found)
}

/// Renames the old keys in the text of the scene `file`; returns the new text and the old keys. All else is unchanged,
/// including comments.
///
/// ```
/// let (text, renamed) = riprap::scene::migrate("[rock]\nsearch = \"host\"  # few blocks\n", "scene.toml")?;
/// assert_eq!(text, "[rock]\nbroadphase = \"host\"  # few blocks\n");
/// assert_eq!((renamed.len(), renamed[0].line), (1, 2));
/// # Ok::<(), riprap::Error>(())
/// ```
///
/// # Errors
/// The errors of [`renamed_keys`].
pub fn migrate(text: &str, file: &str) -> Result<(String, Vec<Renaming>)> {
    let found = renamed_keys(text, file)?;
    let mut migrated = text.to_owned();
    for renaming in found.iter().rev() {
        migrated.replace_range(renaming.span.clone(), renaming.key.new);
    }
    Ok((migrated, found))
}

/// An error about the key at a line and column.
fn refused(file: &str, position: [usize; 2], key: &str, message: &str) -> Error {
    Error::Scene {
        place: Some(Place {
            file: file.to_owned(),
            position: Some(position),
        }),
        key: key.to_owned(),
        message: message.to_owned(),
    }
}

/// Adds the occurrences of `key` in the tables at `path` below `table`.
fn collect(
    (text, file): (&str, &str),
    table: &DeTable<'_>,
    path: &[&str],
    key: &RenamedKey,
    found: &mut Vec<Renaming>,
) -> Result<()> {
    if let Some((first, rest)) = path.split_first() {
        return match table.get(*first).map(|value| value.get_ref()) {
            Some(DeValue::Table(inner)) => collect((text, file), inner, rest, key, found),
            Some(DeValue::Array(all)) => all
                .iter()
                .filter_map(|value| value.get_ref().as_table())
                .try_for_each(|inner| collect((text, file), inner, rest, key, found)),
            _ => Ok(()),
        };
    }
    let Some((name, _)) = table.get_key_value(key.old) else {
        return Ok(());
    };
    let span = name.span();
    let [line, column] = position(text, span.start);
    if table.contains_key(key.new) {
        let message = format!("its table has `{}` too; remove one of the two", key.new);
        return Err(refused(file, [line, column], key.old, &message));
    }
    found.push(Renaming {
        key: *key,
        line,
        column,
        span,
    });
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOTH_FORMS: [&str; 3] = [
        "[rock]\n# where\nsearch = \"host\" # here\nskin = 0.1\n",
        "rock = { skin = 0.1, search = \"host\" }\n",
        "rock.search = \"host\"\n[run]\nsteps = 1\n",
    ];

    #[test]
    fn only_the_key_changes() {
        for text in BOTH_FORMS {
            let (migrated, found) = migrate(text, "").unwrap();
            assert_eq!(migrated, text.replace("search", "broadphase"));
            assert_eq!(found.len(), 1);
            assert!(renamed_keys(&migrated, "").unwrap().is_empty());
        }
    }

    #[test]
    fn the_same_name_elsewhere_stays() {
        let text = "[output]\nsearch = 1\n[[blocks]]\nname = \"search\"\n";
        assert_eq!(migrate(text, "").unwrap(), (text.to_owned(), Vec::new()));
    }

    #[test]
    fn both_names_are_refused() {
        let text = "[rock]\nsearch = \"host\"\nbroadphase = \"auto\"\n";
        let message = migrate(text, "").unwrap_err().to_string();
        assert!(message.contains("2:1: search"), "{message}");
    }

    /// The new names are keys of the format.
    #[test]
    fn the_table_fits_the_format() {
        let schema = crate::scene::Scene::schema().to_value().to_string();
        for key in RENAMED_KEYS {
            assert!(schema.contains(&format!("\"{}\":", key.new)), "{key:?}");
        }
    }
}
