//! Checks that several tables share.

use std::collections::HashSet;

use super::Domain;
use crate::error::{Error, Result};
use crate::formula::Formula;
use glam::DVec3;

/// Longest name: leaves room for a number and an extension in the 255 bytes of a file name.
const LONGEST_NAME: usize = 100;

/// Refuses the value at `key`.
pub(super) fn refuse<T>(key: impl Into<String>, message: impl Into<String>) -> Result<T> {
    Err(Error::scene(key, message))
}

/// `value` must be a number above 0.
pub(super) fn positive(key: impl Into<String>, value: f64, unit: &str) -> Result<()> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    let unit = if unit.is_empty() {
        String::new()
    } else {
        format!(" {unit}")
    };
    refuse(
        key,
        format!("is {value}{unit}; give a number greater than 0"),
    )
}

/// `value` must be a number of at least 0.
pub(super) fn not_negative(key: impl Into<String>, value: f64, unit: &str) -> Result<()> {
    if value.is_finite() && value >= 0.0 {
        return Ok(());
    }
    refuse(
        key,
        format!("is {value} {unit}; give a number from 0").replace(" ;", ";"),
    )
}

/// `direction` must be finite and not zero.
pub(super) fn direction(key: impl Into<String>, direction: &[f64; 3]) -> Result<()> {
    let key = key.into();
    finite(key.as_str(), direction)?;
    if DVec3::from(*direction).try_normalize().is_none() {
        return refuse(
            key,
            "has no direction; give a vector other than 0, such as [0, 0, 1]",
        );
    }
    Ok(())
}

/// Each entry of `point` must be a number.
pub(super) fn finite(key: impl Into<String>, point: &[f64]) -> Result<()> {
    match point.iter().find(|v| !v.is_finite()) {
        None => Ok(()),
        Some(v) => refuse(key, format!("contains {v}; give finite numbers")),
    }
}

/// A time between two outputs must be above 0.
pub(super) fn interval(key: impl Into<String>, every: Option<f64>) -> Result<()> {
    every.map_or(Ok(()), |every| positive(key, every, "s"))
}

/// The formulas may not depend on time.
pub(super) fn no_time(key: &str, formulas: &[Formula]) -> Result<()> {
    match formulas.iter().find(|f| f.uses_time()) {
        None => Ok(()),
        Some(formula) => refuse(
            key,
            format!("`{formula}` uses t; the variables allowed here are x, y, z"),
        ),
    }
}

/// Formulas without variables must give numbers that are finite in f32.
pub(super) fn finite_constants(key: &str, formulas: &[Formula]) -> Result<()> {
    for formula in formulas {
        if let Some(value) = formula.constant()
            && !(value as f32).is_finite()
        {
            return refuse(key, format!("`{formula}` is {value}; give a finite number"));
        }
    }
    Ok(())
}

/// `point` (m) must lie in the domain.
pub(super) fn inside(key: impl Into<String>, domain: &Domain, point: [f64; 3]) -> Result<()> {
    let key = key.into();
    finite(key.clone(), &point)?;
    if domain.contains(point) {
        return Ok(());
    }
    refuse(
        key,
        format!(
            "{} lies outside the domain, which reaches from {} to {} m",
            Point(point),
            Point(domain.origin),
            Point(domain.end())
        ),
    )
}

/// The corners of a box (m) must be in order.
pub(super) fn ordered(key: &str, min: [f64; 3], max: [f64; 3]) -> Result<()> {
    finite(format!("{key}.min"), &min)?;
    finite(format!("{key}.max"), &max)?;
    match (0..3).find(|a| min[*a] >= max[*a]) {
        None => Ok(()),
        Some(a) => refuse(
            format!("{key}.max"),
            format!(
                "the box has no extent along {}: its min {} is not below its max {} m",
                ["x", "y", "z"][a],
                min[a],
                max[a]
            ),
        ),
    }
}

/// A list may neither be empty nor contain anything twice.
pub(super) fn distinct<T: std::hash::Hash + Eq + std::fmt::Debug>(
    key: &str,
    list: &[T],
) -> Result<()> {
    if list.is_empty() {
        return refuse(
            key,
            "the list is empty; name at least one, or leave the key out",
        );
    }
    let mut seen = HashSet::new();
    match list.iter().find(|entry| !seen.insert(*entry)) {
        None => Ok(()),
        Some(twice) => refuse(key, format!("{twice:?} is listed twice; list it once")),
    }
}

/// Names must be valid file names on every system, and distinct.
pub(super) fn names<'a>(list: &str, names: impl Iterator<Item = (usize, &'a str)>) -> Result<()> {
    let mut seen = HashSet::new();
    for (index, name) in names {
        let key = format!("{list}[{index}].name");
        let fits = |c: char| c.is_ascii_alphanumeric() || "._-".contains(c);
        if name.is_empty()
            || name.len() > LONGEST_NAME
            || name.starts_with('.')
            || !name.chars().all(fits)
        {
            return refuse(
                key,
                format!(
                    "`{name}` cannot name a file; use 1 to {LONGEST_NAME} of the characters \
                     A-Z a-z 0-9 _ - . and do not begin with a dot"
                ),
            );
        }
        // Some file systems are not case-sensitive.
        if !seen.insert(name.to_lowercase()) {
            return refuse(
                key,
                format!("the name `{name}` is taken already (case is ignored); choose another"),
            );
        }
    }
    Ok(())
}

/// A point in messages.
pub(super) struct Point(pub [f64; 3]);

impl std::fmt::Display for Point {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [x, y, z] = self.0;
        write!(f, "({x}, {y}, {z})")
    }
}
