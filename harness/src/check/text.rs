//! The report as one reads it.

use super::{Report, lines::Lines, report::Kernel};
use crate::{
    print::{bytes, duration},
    run::LeftOut,
};

impl Report {
    /// The report in lines of a name and what there is of it.
    pub fn text(&self) -> String {
        let mut lines = Lines::titled(&self.title);
        lines.adapter(&self.adapter);
        self.grid(&mut lines);
        self.memory(&mut lines);
        for kernel in &self.kernels {
            let groups = kernel.workgroups;
            lines.add(
                "kernel",
                format_args!("{} ({}), {groups} groups", kernel.file, kernel.entry),
            );
            if !kernel.slots.is_empty() {
                let mut slots: Vec<_> = kernel.slots.values().map(String::as_str).collect();
                slots.sort_unstable();
                lines.add("", format_args!("slots: {}", slots.join(", ")));
            }
            lines.add("", format_args!("buffers: {}", shorten(&kernel.bindings)));
            lines.add("", kernel.work());
        }
        if let Some(left_out) = LeftOut::line(&self.left_out) {
            lines.add("runs", left_out);
        }
        self.numerics(&mut lines);
        if let Some(blocks) = &self.blocks {
            blocks.lines(&mut lines);
        }
        for accuracy in &self.accuracy {
            lines.add("accuracy", accuracy.text());
        }
        lines.warnings(&self.warnings);
        let time = &self.time;
        lines.add(
            "run",
            format_args!(
                "about {} without output: {:.3e} s a step, {:.2} million cells a second \
                 ({} steps tried)",
                duration(time.run),
                time.step,
                time.cells_a_second / 1e6,
                time.trial_steps
            ),
        );
        lines.text()
    }

    fn grid(&self, lines: &mut Lines) {
        let cells = &self.cells;
        let [x, y, z] = cells.size;
        lines.add(
            "cells",
            format_args!(
                "{x} × {y} × {z}: {} fluid, {} solid; {} an invocation",
                cells.fluid, cells.solid, cells.lanes
            ),
        );
        lines.add(
            "bricks",
            format_args!(
                "{} plain, {} mixed, {} never dispatched",
                cells.plain_bricks, cells.mixed_bricks, cells.idle_bricks
            ),
        );
        lines.add(
            "boundaries",
            format_args!(
                "{} links, {} cells at moving walls and velocity faces, {} at pressure faces",
                cells.links, cells.moving, cells.open
            ),
        );
    }

    fn memory(&self, lines: &mut Lines) {
        let memory = &self.memory;
        lines.add("memory", bytes(memory.total));
        for (kind, size) in &memory.kinds {
            let spread = match kind.as_str() {
                "populations" => format!(" in {} bindings", memory.population_bindings),
                _ => String::new(),
            };
            lines.add("", format_args!("{kind}: {}{spread}", bytes(*size)));
        }
    }

    fn numerics(&self, lines: &mut Lines) {
        let n = &self.numerics;
        lines.add(
            "time",
            format_args!(
                "{} steps of {:.4e} s = {:.4} s",
                n.steps, n.time_step, n.duration
            ),
        );
        lines.add("τ", format_args!("{:.6}", n.tau));
        match (n.speed, n.mach, n.cell_reynolds) {
            (Some(speed), Some(mach), Some(reynolds)) => lines.add(
                "speed",
                format_args!(
                    "{speed:.3e} m/s: Mach {mach:.3}, Reynolds number of a cell {reynolds:.2}"
                ),
            ),
            _ => lines.add("speed", "nothing moves at the start"),
        }
        let magic = match (n.lambda, n.wall_lambda) {
            (Some(lambda), _) => format!("{lambda} everywhere, no floor"),
            (None, Some(lambda)) => format!(
                "{lambda} beside walls, odd rates at least {}",
                n.odd_rate_floor
            ),
            (None, None) => "as the collision operator has it".into(),
        };
        lines.add("Λ", magic);
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
