//! Unrolls marked loops.

use crate::{Error, Result};

type Line = (u32, String);

/// Replaces each `for (var q = 0u; q < 27u; q++) { // unroll` by its iterations, including inner loops.
///
/// Bounds and step (`q++` or `q += 2u`) must be literals. Each iteration becomes a separate block in which the counter is a
/// literal.
pub fn unroll(lines: Vec<Line>, file: &str) -> Result<Vec<Line>> {
    let mut out = Vec::with_capacity(lines.len());
    let mut rest = lines.into_iter();
    while let Some((number, text)) = rest.next() {
        if !text.trim_end().ends_with("// unroll") {
            out.push((number, text));
            continue;
        }
        let bad = |message: &str| Error::Shader {
            file: file.into(),
            line: number,
            message: message.into(),
        };
        let head = Head::parse(&text)
            .ok_or_else(|| bad("an unrolled loop reads `for (var q = 0u; q < 27u; q++) {`"))?;
        let mut depth = 1i32;
        let mut body = Vec::new();
        loop {
            let (line, text) = rest.next().ok_or_else(|| bad("the loop does not end"))?;
            let code = text.split("//").next().unwrap_or_default();
            depth += code.matches('{').count() as i32 - code.matches('}').count() as i32;
            if depth == 0 {
                break;
            }
            body.push((line, text));
        }
        for turn in (head.from..head.to).step_by(head.step) {
            let literal = format!("{turn}u");
            let written = body
                .iter()
                .map(|(line, text)| (*line, replace(text, &head.counter, &literal)))
                .collect();
            out.push((number, "{".into()));
            out.extend(unroll(written, file)?);
            out.push((number, "}".into()));
        }
    }
    Ok(out)
}

struct Head {
    counter: String,
    from: u32,
    to: u32,
    step: usize,
}

impl Head {
    fn parse(text: &str) -> Option<Self> {
        let inside = text.trim().strip_prefix("for (var ")?;
        let mut parts = inside[..inside.find(')')?].split(';');
        let (counter, from) = parts.next()?.split_once('=')?;
        let (same, to) = parts.next()?.split_once('<')?;
        let step = parts.next()?.trim();
        let counter = counter.trim();
        let step = step.strip_prefix(counter)?.trim();
        let step = match step.strip_prefix("+=") {
            Some(step) => literal(step)?,
            None => (step == "++").then_some(1)?,
        };
        (same.trim() == counter && step > 0).then_some(())?;
        Some(Self {
            counter: counter.into(),
            from: literal(from)?,
            to: literal(to)?,
            step: step as usize,
        })
    }
}

fn literal(text: &str) -> Option<u32> {
    text.trim().strip_suffix('u')?.parse().ok()
}

/// Replaces the identifier `name`, whole words only.
fn replace(text: &str, name: &str, by: &str) -> String {
    let word = |c: char| c.is_alphanumeric() || c == '_';
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(name) {
        let end = at + name.len();
        let before = rest[..at].chars().next_back().or(out.chars().next_back());
        let free = !before.is_some_and(|c| word(c) || c == '.')
            && !rest[end..].chars().next().is_some_and(word);
        out.push_str(&rest[..at]);
        out.push_str(if free { by } else { name });
        rest = &rest[end..];
    }
    out.push_str(rest);
    out
}
