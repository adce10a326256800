//! Progress of a run on standard error: a bar on a terminal, lines elsewhere.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::{
    io::{IsTerminal, stderr},
    time::{Duration, Instant},
};

/// Time between lines without a terminal, so that the log of an hour stays readable.
const PAUSE: Duration = Duration::from_secs(15);

pub struct Progress {
    bar: Option<ProgressBar>,
    first: u64,
    last: u64,
    start: Instant,
    said: Instant,
}

impl Progress {
    pub fn new(first: u64, last: u64) -> Self {
        let bar = stderr().is_terminal().then(|| {
            let target = ProgressDrawTarget::stderr();
            let bar = ProgressBar::with_draw_target(Some(last), target).with_position(first);
            let form = "{wide_bar} step {pos}/{len}  {msg}";
            bar.set_style(ProgressStyle::with_template(form).unwrap_or_else(|_| {
                // Only reached with a misspelt template.
                ProgressStyle::default_bar()
            }));
            bar
        });
        let now = Instant::now();
        Self {
            bar,
            first,
            last,
            start: now,
            said: now,
        }
    }

    /// Shows that the run is at `step`, with its speed in words, `throughput`.
    pub fn show(&mut self, step: u64, throughput: &str) {
        let done = (step - self.first).max(1) as f64;
        let left = self.start.elapsed().as_secs_f64() / done * (self.last - step) as f64;
        let message = format!("{throughput}, {} left", clock(left));
        if let Some(bar) = &self.bar {
            bar.set_position(step);
            bar.set_message(message);
        } else if self.said.elapsed() >= PAUSE {
            self.said = Instant::now();
            eprintln!("step {step}/{}: {message}", self.last);
        }
    }

    pub fn end(&self) {
        if let Some(bar) = &self.bar {
            bar.abandon();
        }
    }
}

/// `seconds` as minutes and seconds, or hours and minutes.
pub fn clock(seconds: f64) -> String {
    let seconds = seconds.round() as u64;
    match seconds {
        0..3600 => format!("{}:{:02} min", seconds / 60, seconds % 60),
        _ => format!("{}:{:02} h", seconds / 3600, seconds / 60 % 60),
    }
}
