//! Writing to the terminal or into a pipe.

use std::io::{ErrorKind, Write};

/// Prints `text`; a reader that closes the pipe early, such as `head`, is no error.
pub fn print(text: &str) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}

/// Prints `value` as JSON.
pub fn print_json(value: &impl serde::Serialize) -> anyhow::Result<()> {
    print(&(serde_json::to_string_pretty(value)? + "\n"))
}

/// `bytes` with a unit of 1024^n that leaves three to four digits.
pub fn bytes(bytes: u64) -> String {
    let units = ["B", "KiB", "MiB", "GiB", "TiB"];
    let mut value = bytes as f64;
    let mut at = 0;
    while value >= 1024.0 && at + 1 < units.len() {
        value /= 1024.0;
        at += 1;
    }
    let digits = usize::from(at > 0 && value < 100.0);
    format!("{value:.digits$} {}", units[at])
}

/// A time of a run with `decimals` digits after the point; a power of ten if it is long or short.
pub fn time(seconds: f64, decimals: usize) -> String {
    match seconds.abs() {
        s if s == 0.0 || (0.01..1e7).contains(&s) => format!("{seconds:.decimals$} s"),
        _ => format!("{seconds:.decimals$e} s"),
    }
}

/// `seconds` in a unit that suits its size.
pub fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1.0 => format!("{:.0} ms", 1e3 * s),
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.1} h", s / 3600.0),
        s if s < 8.64e10 => format!("{:.1} days", s / 86_400.0),
        s => format!("{:.1e} days", s / 86_400.0),
    }
}

/// A fraction as a percentage with two or three significant digits.
pub fn percent(part: f64) -> String {
    let value = 100.0 * part;
    match value {
        v if v >= 1e4 => format!("{v:.1e} %"),
        v if v >= 9.95 => format!("{v:.0} %"),
        v if v >= 0.995 => format!("{v:.1} %").replace(".0 %", " %"),
        v if v >= 0.0995 => format!("{v:.2} %").replace("0 %", " %"),
        v if v >= 0.000_995 => format!("{v:.*} %", (1.0 - v.log10().floor()) as usize),
        0.0 => "0 %".into(),
        v => format!("{v:.2e} %"),
    }
}

#[cfg(test)]
mod tests {
    use super::{percent, time};

    #[test]
    fn long_and_short_times_have_a_power_of_ten() {
        assert_eq!(time(0.0, 4), "0.0000 s");
        assert_eq!(time(0.3, 4), "0.3000 s");
        assert_eq!(time(1e300, 4), "1.0000e300 s");
        assert_eq!(time(2e-6, 4), "2.0000e-6 s");
    }

    #[test]
    fn percentages_have_the_digits_that_count() {
        assert_eq!(percent(0.05), "5 %");
        assert_eq!(percent(0.001), "0.1 %");
        assert_eq!(percent(0.0123), "1.2 %");
        assert_eq!(percent(0.1234), "12 %");
        assert_eq!(percent(6.08e-4), "0.061 %");
        assert_eq!(percent(3e-5), "0.0030 %");
        assert_eq!(percent(7.08e-6), "7.08e-4 %");
        assert_eq!(percent(0.0), "0 %");
    }
}
