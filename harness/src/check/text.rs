//! The report as one reads it.

use super::{Report, report::Kernel};
use crate::{
    print::{bytes, duration},
    run::LeftOut,
};
use std::fmt::Write;

impl Report {
    /// The report in lines of a name and what there is of it.
    pub fn text(&self) -> String {
        let mut text = format!("{}\n", self.title);
        let mut line = |name: &str, what: String| {
            // A String takes all that is written to it.
            let _ = writeln!(text, "{name:12} {what}");
        };
        let adapter = &self.adapter;
        line(
            "adapter",
            format!("{} ({}, {})", adapter.name, adapter.backend, adapter.driver),
        );
        self.grid(&mut line);
        self.memory(&mut line);
        for kernel in &self.kernels {
            let groups = kernel.workgroups;
            line(
                "kernel",
                format!("{} ({}), {groups} groups", kernel.file, kernel.entry),
            );
            if !kernel.slots.is_empty() {
                let mut slots: Vec<_> = kernel.slots.values().map(String::as_str).collect();
                slots.sort_unstable();
                line("", format!("slots: {}", slots.join(", ")));
            }
            line("", format!("buffers: {}", shorten(&kernel.bindings)));
            line("", kernel.work());
        }
        if let Some(left_out) = LeftOut::line(&self.left_out) {
            line("runs", left_out);
        }
        self.numerics(&mut line);
        if let Some(blocks) = &self.blocks {
            blocks.lines(&mut line);
        }
        for accuracy in &self.accuracy {
            line("accuracy", accuracy.text());
        }
        for warning in &self.warnings {
            line("warning", warning.clone());
        }
        let time = &self.time;
        line(
            "run",
            format!(
                "about {} without output: {:.3e} s a step, {:.2} million cells a second \
                 ({} steps tried)",
                duration(time.run),
                time.step,
                time.cells_a_second / 1e6,
                time.trial_steps
            ),
        );
        text
    }

    fn grid(&self, line: &mut impl FnMut(&str, String)) {
        let cells = &self.cells;
        let [x, y, z] = cells.size;
        line(
            "cells",
            format!(
                "{x} × {y} × {z}: {} fluid, {} solid; {} an invocation",
                cells.fluid, cells.solid, cells.lanes
            ),
        );
        line(
            "bricks",
            format!(
                "{} plain, {} mixed, {} never dispatched",
                cells.plain_bricks, cells.mixed_bricks, cells.idle_bricks
            ),
        );
        line(
            "boundaries",
            format!(
                "{} links, {} cells at moving walls and velocity faces, {} at pressure faces",
                cells.links, cells.moving, cells.open
            ),
        );
    }

    fn memory(&self, line: &mut impl FnMut(&str, String)) {
        let memory = &self.memory;
        line("memory", bytes(memory.total));
        for (kind, size) in &memory.kinds {
            let spread = match kind.as_str() {
                "populations" => format!(" in {} bindings", memory.population_bindings),
                _ => String::new(),
            };
            line("", format!("{kind}: {}{spread}", bytes(*size)));
        }
    }

    fn numerics(&self, line: &mut impl FnMut(&str, String)) {
        let n = &self.numerics;
        line(
            "time",
            format!(
                "{} steps of {:.4e} s = {:.4} s",
                n.steps, n.time_step, n.duration
            ),
        );
        line("τ", format!("{:.6}", n.tau));
        match (n.speed, n.mach, n.cell_reynolds) {
            (Some(speed), Some(mach), Some(reynolds)) => line(
                "speed",
                format!("{speed:.3e} m/s: Mach {mach:.3}, Reynolds number of a cell {reynolds:.2}"),
            ),
            _ => line("speed", "nothing moves at the start".into()),
        }
        let magic = match (n.lambda, n.wall_lambda) {
            (Some(lambda), _) => format!("{lambda} everywhere, no floor"),
            (None, Some(lambda)) => format!(
                "{lambda} beside walls, odd rates at least {}",
                n.odd_rate_floor
            ),
            (None, None) => "as the collision operator has it".into(),
        };
        line("Λ", magic);
    }
}

impl Kernel {
    /// What an invocation does, and all of them together in a step.
    fn work(&self) -> String {
        let all = f64::from(self.workgroups) * f64::from(self.invocations);
        let open = match self.loops {
            0 => String::new(),
            n => format!("; of {n} loops one turn is counted"),
        };
        format!(
            "an invocation: {} flop, {} B read, {} B written at most; all: {:.3e} flop, {}{open}",
            self.flops,
            self.read,
            self.written,
            all * self.flops as f64,
            bytes((all * (self.read + self.written) as f64) as u64),
        )
    }
}

/// The names, those that are numbered in a row as the first and the last.
fn shorten(names: &[String]) -> String {
    let numbered: Vec<_> = names
        .iter()
        .filter(|name| name.starts_with("populations_"))
        .collect();
    let rest = names.iter().filter(|name| !numbered.contains(name));
    let first = match numbered.as_slice() {
        [] => None,
        [one] => Some((*one).clone()),
        [first, .., last] => Some(format!("{first} to {last}")),
    };
    first
        .into_iter()
        .chain(rest.cloned())
        .collect::<Vec<_>>()
        .join(", ")
}
