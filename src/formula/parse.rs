//! Recursive-descent parser from text to postfix operations, with the functions and constants that it knows.
//!
//! ```text
//! sum    = term  { ("+" | "-") term }
//! term   = factor { ("*" | "/") factor }
//! factor = ("+" | "-") factor | power
//! power  = atom [ "^" factor ]
//! atom   = number | name | name "(" sum { "," sum } ")" | "(" sum ")"
//! ```

use super::{Formula, FormulaError, Op, STACK, Series, VARIABLES};

pub(super) fn compile(text: &str) -> Result<(Vec<Op>, Vec<Series>), FormulaError> {
    let mut parser = Parser {
        text,
        at: 0,
        nesting: 0,
        ops: Vec::new(),
        series: Vec::new(),
    };
    parser.sum()?;
    match parser.peek() {
        None => parser.bounded(),
        Some(found) => Err(parser.error(format!(
            "`{found}` is not expected here; an operator + - * / ^ may be missing"
        ))),
    }
}

struct Parser<'a> {
    text: &'a str,
    /// Byte offset of the next character.
    at: usize,
    nesting: usize,
    ops: Vec<Op>,
    series: Vec<Series>,
}

impl Parser<'_> {
    fn error(&self, message: impl Into<String>) -> FormulaError {
        FormulaError {
            text: self.text.to_owned(),
            column: self.text[..self.at].chars().count() + 1,
            message: message.into(),
        }
    }

    fn peek(&mut self) -> Option<char> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        self.text[self.at..].chars().next()
    }

    fn take(&mut self, wanted: char) -> bool {
        let found = self.peek() == Some(wanted);
        if found {
            self.at += wanted.len_utf8();
        }
        found
    }

    fn close(&mut self) -> Result<(), FormulaError> {
        if self.take(')') {
            return Ok(());
        }
        Err(self.error("`)` is missing"))
    }

    fn sum(&mut self) -> Result<(), FormulaError> {
        self.term()?;
        loop {
            let function: fn(f64, f64) -> f64 = if self.take('+') {
                |a, b| a + b
            } else if self.take('-') {
                |a, b| a - b
            } else {
                return Ok(());
            };
            self.term()?;
            self.ops.push(Op::Binary(function));
        }
    }

    fn term(&mut self) -> Result<(), FormulaError> {
        self.factor()?;
        loop {
            let function: fn(f64, f64) -> f64 = if self.take('*') {
                |a, b| a * b
            } else if self.take('/') {
                |a, b| a / b
            } else {
                return Ok(());
            };
            self.factor()?;
            self.ops.push(Op::Binary(function));
        }
    }

    fn factor(&mut self) -> Result<(), FormulaError> {
        self.nesting += 1;
        // Every level of recursion passes here, so this bounds the call stack too.
        if self.nesting > STACK {
            return Err(self.error(format!("nested deeper than {STACK} levels; simplify it")));
        }
        if self.take('-') {
            self.factor()?;
            self.ops.push(Op::Unary(|a| -a));
        } else if self.take('+') {
            self.factor()?;
        } else {
            self.atom()?;
            if self.take('^') {
                self.factor()?;
                self.ops.push(Op::Binary(f64::powf));
            }
        }
        self.nesting -= 1;
        Ok(())
    }

    fn atom(&mut self) -> Result<(), FormulaError> {
        match self.peek() {
            Some('(') => {
                self.take('(');
                self.sum()?;
                self.close()
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() || c == '_' => self.name(),
            Some(c) => Err(self.error(format!("a number, a name or `(` is expected, not `{c}`"))),
            None => Err(self.error("a number, a name or `(` is expected, but the text ends")),
        }
    }

    fn number(&mut self) -> Result<(), FormulaError> {
        let bytes = self.text.as_bytes();
        let digits = |from: usize| {
            let more = bytes[from..].iter().take_while(|b| b.is_ascii_digit());
            from + more.count()
        };
        let mut end = digits(self.at);
        if bytes.get(end) == Some(&b'.') {
            end = digits(end + 1);
        }
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
            let after = digits(end + 1 + sign);
            if after > end + 1 + sign {
                end = after;
            }
        }
        match self.text[self.at..end].parse() {
            Ok(value) => {
                self.ops.push(Op::Number(value));
                self.at = end;
                Ok(())
            }
            Err(_) => Err(self.error(format!("`{}` is not a number", &self.text[self.at..end]))),
        }
    }

    fn name(&mut self) -> Result<(), FormulaError> {
        let rest = &self.text[self.at..];
        let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_'));
        let name = &rest[..end.unwrap_or(rest.len())];
        if let Some(function) = unary(name) {
            self.arguments(name, 1)?;
            self.ops.push(Op::Unary(function));
        } else if let Some(function) = binary(name) {
            self.arguments(name, 2)?;
            self.ops.push(Op::Binary(function));
        } else if name == "interpolate" {
            self.interpolate()?;
        } else if let Some(value) = constant(name) {
            self.at += name.len();
            self.ops.push(Op::Number(value));
        } else if let Some(index) = VARIABLES.iter().position(|v| *v == name) {
            self.at += name.len();
            self.ops.push(Op::Variable(index as u8));
        } else if rest[name.len()..].trim_start().starts_with('(') {
            return Err(self.error(format!(
                "there is no function `{name}`; use sin, cos, tan, asin, acos, atan, sinh, cosh, \
                 tanh, exp, log, log10, sqrt, abs, sign, floor, ceil, min, max, atan2, mod, interpolate"
            )));
        } else {
            return Err(self.error(format!(
                "there is no variable `{name}`; allowed are {} and the constants pi, e",
                VARIABLES.join(", ")
            )));
        }
        Ok(())
    }

    fn arguments(&mut self, name: &str, count: usize) -> Result<(), FormulaError> {
        self.at += name.len();
        if !self.take('(') {
            return Err(self.error(format!("`(` must follow the function `{name}`")));
        }
        self.sum()?;
        for _ in 1..count {
            if !self.take(',') {
                return Err(self.error(format!("`{name}` takes {count} arguments")));
            }
            self.sum()?;
        }
        if self.peek() == Some(',') {
            return Err(self.error(format!("`{name}` takes {count} argument(s)")));
        }
        self.close()
    }

    /// Parses the argument of `interpolate` and its points, which are pairs of numbers.
    fn interpolate(&mut self) -> Result<(), FormulaError> {
        self.at += "interpolate".len();
        if !self.take('(') {
            return Err(self.error("`(` must follow the function `interpolate`"));
        }
        self.sum()?;
        let mut numbers = Vec::new();
        while self.take(',') {
            numbers.push(self.fixed()?);
        }
        let points: Vec<[f64; 2]> = numbers
            .chunks_exact(2)
            .map(|pair| [pair[0], pair[1]])
            .collect();
        if points.len() < 2 || numbers.len() % 2 == 1 {
            return Err(self.error(format!(
                "`interpolate` takes an argument and at least two points, each of a place and a value; here are {} \
                 numbers after the argument",
                numbers.len()
            )));
        }
        if let Some(pair) = points.windows(2).find(|pair| pair[1][0] <= pair[0][0]) {
            return Err(self.error(format!(
                "the places of `interpolate` ascend, and {} follows {}",
                pair[1][0], pair[0][0]
            )));
        }
        let Ok(number) = u16::try_from(self.series.len()) else {
            return Err(self.error("so many calls of `interpolate` are not possible"));
        };
        self.series.push(points.into());
        self.ops.push(Op::Interpolate(number));
        self.close()
    }

    /// Parses a number or a formula without variables.
    fn fixed(&mut self) -> Result<f64, FormulaError> {
        let before = self.ops.len();
        self.sum()?;
        let own = Formula {
            text: String::new(),
            ops: self.ops.split_off(before),
            series: self.series.clone(),
        };
        match own.constant().filter(|value| value.is_finite()) {
            Some(value) => Ok(value),
            None => Err(self.error("the points of `interpolate` are finite numbers")),
        }
    }

    /// Returns the operations if their evaluation never holds more than [`STACK`] values.
    fn bounded(self) -> Result<(Vec<Op>, Vec<Series>), FormulaError> {
        let mut depth = 0_usize;
        let mut most = 0;
        for op in &self.ops {
            match op {
                Op::Number(_) | Op::Variable(_) => depth += 1,
                Op::Unary(_) | Op::Interpolate(_) => {}
                Op::Binary(_) => depth -= 1,
            }
            most = most.max(depth);
        }
        if most > STACK {
            return Err(self.error(format!("nested deeper than {STACK} levels; simplify it")));
        }
        Ok((self.ops, self.series))
    }
}

/// Value of a named constant.
fn constant(name: &str) -> Option<f64> {
    match name {
        "pi" | "π" => Some(std::f64::consts::PI),
        "e" => Some(std::f64::consts::E),
        _ => None,
    }
}

/// Function of one argument.
fn unary(name: &str) -> Option<fn(f64) -> f64> {
    Some(match name {
        "sin" => f64::sin,
        "cos" => f64::cos,
        "tan" => f64::tan,
        "asin" => f64::asin,
        "acos" => f64::acos,
        "atan" => f64::atan,
        "sinh" => f64::sinh,
        "cosh" => f64::cosh,
        "tanh" => f64::tanh,
        "exp" => f64::exp,
        "log" | "ln" => f64::ln,
        "log10" => f64::log10,
        "sqrt" => f64::sqrt,
        "abs" => f64::abs,
        "sign" => sign,
        "floor" => f64::floor,
        "ceil" => f64::ceil,
        _ => return None,
    })
}

/// Function of two arguments.
fn binary(name: &str) -> Option<fn(f64, f64) -> f64> {
    Some(match name {
        "min" => least,
        "max" => greatest,
        "atan2" => f64::atan2,
        "mod" => f64::rem_euclid,
        _ => return None,
    })
}

/// −1, 0 or 1: zero stays zero, unlike in `f64::signum`.
fn sign(value: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value.signum() }
}

/// Minimum that propagates NaN, unlike `f64::min`, so that the caller detects an invalid value.
fn least(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else {
        a.min(b)
    }
}

/// Maximum that propagates NaN; see [`least`].
fn greatest(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else {
        a.max(b)
    }
}
