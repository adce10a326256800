//! Series of numbers in files that formulas name: `interpolate(t, 'flow.csv')`.

use std::path::Path;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::parse::Refusal;
use crate::output::Table;

/// Replaces the names of files in formulas by their numbers; paths are relative to `dir`.
pub(super) fn insert(table: &mut DeTable<'_>, dir: &Path) -> Result<(), Refusal> {
    table.iter_mut().try_for_each(|(key, value)| {
        let key = key.get_ref().to_string();
        // Names and titles are not formulas.
        if matches!(key.as_str(), "title" | "name") {
            return Ok(());
        }
        insert_in(value, dir).map_err(|refusal| refusal.below(&key))
    })
}

fn insert_in(value: &mut Spanned<DeValue<'_>>, dir: &Path) -> Result<(), Refusal> {
    let span = value.span();
    match value.get_mut() {
        DeValue::Table(table) => insert(table, dir),
        DeValue::Array(list) => list.iter_mut().try_for_each(|value| insert_in(value, dir)),
        DeValue::String(text) if text.contains("interpolate(") && text.contains('\'') => {
            let expanded = expand(text, dir).map_err(|message| Refusal {
                span: Some(span),
                key: String::new(),
                message,
            })?;
            *text = expanded.into();
            Ok(())
        }
        _ => Ok(()),
    }
}

/// The formula with numbers in place of each `'FILE'`.
fn expand(text: &str, dir: &Path) -> Result<String, String> {
    let mut parts = text.split('\'');
    let mut expanded = parts.next().unwrap_or_default().to_owned();
    while let Some(file) = parts.next() {
        let Some(rest) = parts.next() else {
            return Err(format!("`{text}`: the name of a file ends with a second '"));
        };
        expanded += &points(&dir.join(file))?;
        expanded += rest;
    }
    Ok(expanded)
}

/// The two columns of a file, row by row, as arguments of `interpolate`.
fn points(path: &Path) -> Result<String, String> {
    let table = Table::read(path).map_err(|error| error.to_string())?;
    let refused = |why: &str| Err(format!("{}: {why}", path.display()));
    if matches!(&table.columns[..], [(name, _)] if name.is_empty()) {
        return refused("it is empty; give two columns of numbers under one line of names");
    }
    let [(first, x), (second, y)] = &table.columns[..] else {
        return refused(&format!(
            "it has {} columns; a series has two, such as time and velocity, under one line of names",
            table.columns.len()
        ));
    };
    if [first, second]
        .iter()
        .any(|name| name.parse::<f64>().is_ok())
    {
        return refused("its first line is of numbers; give the names of the columns there");
    }
    if x.is_empty() {
        return refused("it has no numbers under its line of names");
    }
    let bad = |(x, y): (&f64, &f64)| !x.is_finite() || !y.is_finite();
    if let Some(row) = x.iter().zip(y).position(bad) {
        return refused(&format!(
            "row {} under the line of names is {}, {}; give finite numbers",
            row + 1,
            x[row],
            y[row]
        ));
    }
    if let Some(row) = x.windows(2).position(|pair| pair[1] <= pair[0]) {
        return refused(&format!(
            "{first} ascends from row to row, and in row {} under the line of names {} follows {}; sort the rows, and remove doubles",
            row + 2,
            x[row + 1],
            x[row]
        ));
    }
    let pairs: Vec<String> = x
        .iter()
        .zip(y)
        .map(|(x, y)| format!("{x:?}, {y:?}"))
        .collect();
    Ok(pairs.join(", "))
}
