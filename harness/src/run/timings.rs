//! The table of `--timings`: phases of steps by name.

use riprap::simulation::Phase;
use std::fmt::Write;

/// A line for each phase: its name, how often it ran, and its times.
pub fn table(phases: &[Phase]) -> String {
    let mut text = format!(
        "{:20} {:>10} {:>12} {:>12}\n",
        "phase", "times", "mean, ms", "total, s"
    );
    for Phase {
        name,
        count,
        seconds,
    } in phases
    {
        let mean = 1e3 * seconds / (*count).max(1) as f64;
        // A String takes all that is written to it.
        let _ = writeln!(text, "{name:20} {count:>10} {mean:>12.4} {seconds:>12.4}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_phase_has_its_mean_and_its_total() {
        let phase = Phase {
            name: "bulk".into(),
            count: 4,
            seconds: 0.01,
        };
        let text = table(&[phase]);
        let line: Vec<_> = text.lines().nth(1).unwrap().split_whitespace().collect();
        assert_eq!(line, ["bulk", "4", "2.5000", "0.0100"]);
    }
}
