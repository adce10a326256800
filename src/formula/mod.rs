//! Numbers that may also be written as formulas of position and time.

mod parse;
#[cfg(feature = "scene")]
mod scene_text;

use std::{fmt, sync::Arc};

/// Variables that a formula may use, in the order of the arguments of [`Formula::eval`].
pub const VARIABLES: [&str; 4] = ["x", "y", "z", "t"];
/// Index of the time in [`VARIABLES`].
const TIME: u8 = 3;
/// Largest depth of the evaluation stack; the parser refuses deeper nesting.
const STACK: usize = 64;

/// One step of a formula in postfix order.
#[derive(Clone, Copy, Debug)]
enum Op {
    Number(f64),
    Variable(u8),
    Unary(fn(f64) -> f64),
    Binary(fn(f64, f64) -> f64),
    /// Linear interpolation in the series with this index.
    Interpolate(u16),
}

/// Points of a piecewise linear function: abscissa and value, abscissas ascending.
type Series = Arc<[[f64; 2]]>;

/// Value of a series at the abscissa `place`: linear between its points, constant beyond them.
fn interpolate(series: &[[f64; 2]], place: f64) -> f64 {
    let after = series.partition_point(|[x, _]| *x <= place);
    match (
        after.checked_sub(1).map(|n| series[n]),
        series.get(after).copied(),
    ) {
        _ if place.is_nan() => f64::NAN,
        (Some([x0, y0]), Some([x1, y1])) => y0 + (y1 - y0) * (place - x0) / (x1 - x0),
        (Some([_, y]), None) | (None, Some([_, y])) => y,
        (None, None) => f64::NAN,
    }
}

/// A number, or a formula of x, y, z (m) and t (s) as text.
///
/// Operators `+ - * / ^` with the precedence of mathematics (`-x^2` is `-(x^2)`, `^` groups to
/// the right), parentheses, the constants `pi` and `e`, and the functions sin, cos, tan, asin,
/// acos, atan, sinh, cosh, tanh, exp, log (= ln), log10, sqrt, abs, sign, floor, ceil, and, with
/// two arguments, min, max, atan2, mod. `interpolate(t, 0, 0.5, 10, 2)` is linear in its first argument between
/// points, here from 0.5 at 0 to 2 at 10, and constant beyond them.
///
/// ```
/// let profile: riprap::formula::Formula = "1 - (y/0.1)^2".parse().unwrap();
/// assert_eq!(profile.eval(0.0, 0.05, 0.0, 0.0), 0.75);
/// ```
#[derive(Clone, Debug)]
pub struct Formula {
    text: String,
    ops: Vec<Op>,
    series: Vec<Series>,
}

impl Formula {
    /// The formula that is `value` everywhere.
    pub fn number(value: f64) -> Self {
        Self {
            text: value.to_string(),
            ops: vec![Op::Number(value)],
            series: Vec::new(),
        }
    }

    /// Value at the point (`x`, `y`, `z`) in m and the time `t` in s. May be NaN or infinite.
    pub fn eval(&self, x: f64, y: f64, z: f64, t: f64) -> f64 {
        let variables = [x, y, z, t];
        let mut stack = [0.0; STACK];
        let mut top = 0;
        for op in &self.ops {
            match *op {
                Op::Number(value) => {
                    stack[top] = value;
                    top += 1;
                }
                Op::Variable(index) => {
                    stack[top] = variables[usize::from(index)];
                    top += 1;
                }
                Op::Unary(function) => stack[top - 1] = function(stack[top - 1]),
                Op::Interpolate(series) => {
                    let series = &self.series[usize::from(series)];
                    stack[top - 1] = interpolate(series, stack[top - 1]);
                }
                Op::Binary(function) => {
                    top -= 1;
                    stack[top - 1] = function(stack[top - 1], stack[top]);
                }
            }
        }
        stack[0]
    }

    /// Value at the point `at` in m and the time `t` in s. May be NaN or infinite.
    pub fn eval_at(&self, at: [f64; 3], t: f64) -> f64 {
        self.eval(at[0], at[1], at[2], t)
    }

    /// Whether the value depends on the time.
    pub fn uses_time(&self) -> bool {
        self.uses(|index| index == TIME)
    }

    /// Whether the value depends on the position.
    pub fn uses_place(&self) -> bool {
        self.uses(|index| index != TIME)
    }

    /// Whether the value depends on neither position nor time.
    pub fn is_constant(&self) -> bool {
        !self.uses(|_| true)
    }

    /// The value, if it depends on neither position nor time.
    pub fn constant(&self) -> Option<f64> {
        self.is_constant().then(|| self.eval(0.0, 0.0, 0.0, 0.0))
    }

    /// The formula as it was written.
    pub fn text(&self) -> &str {
        &self.text
    }

    fn uses(&self, which: impl Fn(u8) -> bool) -> bool {
        self.ops
            .iter()
            .any(|op| matches!(op, Op::Variable(index) if which(*index)))
    }
}

impl Default for Formula {
    fn default() -> Self {
        Self::number(0.0)
    }
}

impl From<f64> for Formula {
    fn from(value: f64) -> Self {
        Self::number(value)
    }
}

impl PartialEq for Formula {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

impl fmt::Display for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// Text of a formula for a message, truncated if it is long.
fn shown(text: &str) -> std::borrow::Cow<'_, str> {
    /// Longest text that is shown in full, characters.
    const MOST: usize = 200;
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}…", &text[..end]).into(),
        None => text.into(),
    }
}

/// Error for a text that is not a valid formula.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("formula `{}`, character {column}: {message}", shown(text))]
pub struct FormulaError {
    /// The text.
    pub text: String,
    /// Position of the error: character, counted from 1.
    pub column: usize,
    /// What is wrong at this character.
    pub message: String,
}

impl std::str::FromStr for Formula {
    type Err = FormulaError;

    fn from_str(text: &str) -> Result<Self, FormulaError> {
        let (ops, series) = parse::compile(text)?;
        Ok(Self {
            text: text.to_owned(),
            ops,
            series,
        })
    }
}
