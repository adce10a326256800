//! Assertions on numbers and texts that print the values found.

use std::fmt::Display;

/// Fails unless |found − exact| < `limit`.
#[track_caller]
pub fn assert_near(found: impl Into<f64>, exact: impl Into<f64>, limit: f64) {
    let (found, exact) = (found.into(), exact.into());
    let error = (found - exact).abs();
    // A comparison with NaN is false, so that NaN fails.
    assert!(
        error < limit,
        "{found}, not {exact}: off by {error:e}, allowed are {limit:e}"
    );
}

/// Fails unless |found/exact − 1| < `limit`.
#[track_caller]
pub fn assert_relative(found: impl Into<f64>, exact: impl Into<f64>, limit: f64) {
    let (found, exact) = (found.into(), exact.into());
    let error = (found / exact - 1.0).abs();
    assert!(
        error < limit,
        "{found}, not {exact}: off by {error:e} of it, allowed are {limit:e}"
    );
}

/// Fails unless each of the parts occurs in the text.
#[track_caller]
pub fn assert_contains(text: impl Display, parts: &[impl AsRef<str>]) {
    let text = text.to_string();
    for part in parts.iter().map(AsRef::as_ref) {
        assert!(text.contains(part), "`{part}` is not in: {text}");
    }
}
