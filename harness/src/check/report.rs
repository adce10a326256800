//! Report on a scene with a lattice.

use super::{Accuracy, Immersion, lines::Lines, trial::Trial};
use crate::{
    adapters::Adapter,
    bench::Work,
    print::{bytes, duration, time},
    run::{Coupling, SkippedWork},
};
use anyhow::Result;
use riprap::{
    lattice::Lattice, psm::SolidCells, scene::Scene, simulation::Simulation, units::Units,
};
use serde::Serialize;
use std::collections::BTreeMap;

/// What `riprap check` reports on a lattice.
#[derive(Debug, Serialize)]
pub struct Report {
    /// Title of the scene.
    pub title: String,
    /// The adapter on which it runs.
    pub adapter: Adapter,
    /// The grid.
    pub cells: Cells,
    /// Bytes on the device.
    pub memory: Memory,
    /// Dispatches of a step.
    pub kernels: Vec<Kernel>,
    /// Features that the scene does not use and the kernels skip.
    pub left_out: Vec<SkippedWork>,
    /// Time step and parameters of the method.
    pub numerics: Numerics,
    /// The blocks, if there are any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub blocks: Option<Immersion>,
    /// Expected errors of forces, as measured by `riprap report`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub accuracy: Vec<Accuracy>,
    /// Warnings about the scene.
    pub warnings: Vec<String>,
    /// Running time.
    pub time: Time,
}

/// The grid.
#[derive(Debug, Serialize)]
pub struct Cells {
    /// Cells along x, y, z.
    pub size: [u32; 3],
    /// Fluid cells.
    pub fluid: u64,
    /// Cells of static solids.
    pub solid: u64,
    /// Cells per invocation.
    pub lanes: u32,
    /// Groups of 64 invocations of plain fluid.
    pub plain_bricks: u64,
    /// Groups with a wall, a solid or a face.
    pub mixed_bricks: u64,
    /// Groups without fluid, which are never dispatched.
    pub idle_bricks: u64,
    /// Populations that walls and free-slip faces reflect in each step.
    pub links: u64,
    /// Cells at moving walls and velocity faces.
    pub moving: u64,
    /// Cells at pressure faces.
    pub open: u64,
    /// Faces of fluid cells that are walls or solids at rest.
    pub wall_faces: u64,
    /// Faces with a wall model.
    pub modelled_faces: u64,
}

/// Bytes on the device.
#[derive(Debug, Serialize)]
pub struct Memory {
    /// Bytes by kind of buffer.
    pub kinds: BTreeMap<String, u64>,
    /// Bytes in all.
    pub total: u64,
    /// Storage bindings that hold the populations.
    pub population_bindings: u32,
}

/// A dispatch of a step.
#[derive(Debug, Serialize)]
pub struct Kernel {
    /// File under `kernels/`, without folder and ending.
    pub file: String,
    /// Its entry point.
    pub entry: String,
    /// Its slots, with the files that fill them.
    pub slots: BTreeMap<String, String>,
    /// Names of its buffers.
    pub bindings: Vec<String>,
    /// Workgroups.
    pub workgroups: u32,
    /// Invocations per workgroup.
    pub invocations: u32,
    /// Floating-point operations of an invocation on its longest path, counted from the code.
    pub flops: u64,
    /// Bytes that an invocation reads from buffers, counted likewise.
    pub read: u64,
    /// Bytes that it writes.
    pub written: u64,
    /// Loops whose number of iterations is not in the code; each counts as one iteration.
    pub loops: u64,
}

/// Time step and parameters of the method.
#[derive(Debug, Serialize)]
pub struct Numerics {
    /// Time step, s.
    pub time_step: f64,
    /// Steps of the run.
    pub steps: u64,
    /// Simulated time of the run, s.
    pub duration: f64,
    /// Relaxation time of the viscosity, lattice units.
    pub tau: f64,
    /// Reference speed of the Mach and Reynolds numbers, m/s; `None` if nothing moves at the start.
    pub speed: Option<f64>,
    /// Mach number of the lattice at that speed.
    pub mach: Option<f64>,
    /// Reynolds number of a cell at that speed.
    pub cell_reynolds: Option<f64>,
    /// Magic parameter of the odd moments, if it is the same everywhere.
    pub lambda: Option<f64>,
    /// Magic parameter of the odd moments at walls.
    pub wall_lambda: Option<f64>,
    /// Smallest relaxation rates of the odd moments next to walls and next to solids.
    pub odd_rate_floors: [f64; 2],
    /// Magic parameter of the odd moments next to blocks and exact terrain, if there are any.
    pub solid_lambda: Option<f64>,
}

/// Running time without output.
#[derive(Debug, Serialize)]
pub struct Time {
    /// One step, s.
    pub step: f64,
    /// All steps, s.
    pub run: f64,
    /// Updates of fluid cells per second.
    pub cells_a_second: f64,
    /// Steps that were timed.
    pub trial_steps: u64,
}

impl Report {
    /// The report on a scene after the steps of the trial.
    pub fn of(
        simulation: &Simulation,
        (lattice, units): (&Lattice, &Units),
        adapter: Adapter,
        trial: &Trial,
    ) -> Result<Self> {
        let solid_cells = simulation.coupled().map(|coupled| coupled.solid_cells());
        let scene = simulation.scene();
        let warnings = simulation.advice().iter().map(ToString::to_string);
        let cells = Coupling::of(simulation, simulation.step());
        let numerics = Numerics::of(scene, lattice, units)?;
        let step = trial.step();
        let fluid_cells = lattice.geometry().fluid_cells as f64;
        Ok(Self {
            title: scene.title.clone(),
            adapter,
            cells: Cells::of(lattice),
            memory: Memory::of(lattice, simulation),
            kernels: lattice
                .kernels(false)
                .chain(lattice.sampling_kernels(false))
                .chain(solid_cells.into_iter().flat_map(SolidCells::kernels))
                .map(Kernel::of)
                .collect(),
            left_out: SkippedWork::of_lattice(lattice)
                .into_iter()
                .chain(
                    cells
                        .as_ref()
                        .map(SkippedWork::of_places)
                        .into_iter()
                        .flatten(),
                )
                .collect(),
            accuracy: Accuracy::all(simulation, numerics.speed),
            warnings: warnings.collect(),
            blocks: Immersion::of(simulation, simulation.step()),
            time: Time {
                step,
                run: step * numerics.steps as f64,
                cells_a_second: if step > 0.0 { fluid_cells / step } else { 0.0 },
                trial_steps: trial.steps,
            },
            numerics,
        })
    }
}

impl Cells {
    fn of(lattice: &Lattice) -> Self {
        let (grid, geometry) = (lattice.grid(), lattice.geometry());
        Self {
            size: grid.cells,
            fluid: geometry.fluid_cells,
            solid: grid.cell_count() as u64 - geometry.fluid_cells,
            lanes: grid.lanes,
            plain_bricks: geometry.plain.len() as u64,
            mixed_bricks: (geometry.mixed.len() + geometry.surface.len()) as u64,
            idle_bricks: u64::from(geometry.solid_bricks),
            links: geometry.link_count() as u64,
            moving: geometry.moving.len() as u64,
            open: (geometry.pressure.len() + geometry.outflow.len()) as u64,
            wall_faces: geometry.walls.area,
            modelled_faces: geometry.walls.cells.len() as u64,
        }
    }
}

impl Memory {
    fn of(lattice: &Lattice, simulation: &Simulation) -> Self {
        let bytes = lattice.bytes().into_iter();
        let mut kinds: BTreeMap<_, _> = bytes.map(|(kind, n)| (kind.to_owned(), n)).collect();
        // Density and three components of the velocity in f32.
        let output = 16 * lattice.grid().cell_count() as u64;
        kinds.insert("density and velocity for output".into(), output);
        if let Some(coupled) = simulation.coupled() {
            kinds.insert("blocks".into(), coupled.solid_cells().bytes());
        }
        if simulation.statistics_bytes() > 0 {
            let bytes = simulation.statistics_bytes();
            kinds.insert("statistics over time".into(), bytes);
        }
        Self {
            total: kinds.values().sum(),
            kinds,
            population_bindings: lattice.population_buffers().len() as u32,
        }
    }
}

impl Kernel {
    fn of((kernel, workgroups): (&riprap::gpu::kernel::Kernel, u32)) -> Self {
        let work = Work::of(kernel.linked(), kernel.entry());
        Self {
            file: kernel.file().into(),
            entry: kernel.entry().into(),
            slots: kernel.slots().iter().cloned().collect(),
            bindings: kernel.bindings().iter().map(|b| b.name.clone()).collect(),
            workgroups,
            invocations: kernel.invocations(),
            flops: work.flops,
            read: work.read,
            written: work.written,
            loops: work.loops,
        }
    }
}

impl Numerics {
    fn of(scene: &Scene, lattice: &Lattice, units: &Units) -> Result<Self> {
        let setup = lattice.setup();
        let given = scene.numerics.velocity_scale.unwrap_or_default();
        let speed = Some(given.max(scene.sampled_speed()?)).filter(|speed| *speed > 0.0);
        Ok(Self {
            time_step: units.time_step,
            steps: scene.run.step_count(units),
            duration: scene.run.duration(units),
            tau: setup.tau(),
            speed,
            mach: speed.map(|speed| units.mach(speed)),
            cell_reynolds: speed.map(|speed| speed * units.cell / scene.fluid.viscosity),
            lambda: setup.lambda,
            wall_lambda: setup.wall_lambda,
            odd_rate_floors: setup.odd_rate_floors(),
            solid_lambda: setup.solid_lambda.filter(|_| setup.operator().is_some()),
        })
    }
}

impl Report {
    /// The report, one line per item.
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
        if let Some(left_out) = SkippedWork::line(&self.left_out) {
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
                "about {} without output: {:.3e} s per step, {:.2} million cells per second \
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
                "{x} × {y} × {z}: {} fluid, {} solid; {} per invocation",
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
        if cells.modelled_faces > 0 {
            let share = 100.0 * cells.modelled_faces as f64 / cells.wall_faces as f64;
            lines.add(
                "wall model",
                format_args!(
                    "on {share:.1} % of the area of walls at rest; no slip at convex edges, in corners, in gaps under five cells, \
                     and beside open and moving faces"
                ),
            );
        }
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
                "{} steps of {:.4e} s = {}",
                n.steps,
                n.time_step,
                time(n.duration, 4)
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
        let [wall, solid] = n.odd_rate_floors;
        let mut magic = match (n.lambda, n.wall_lambda) {
            (Some(lambda), _) => format!("{lambda} everywhere, no floor"),
            (None, Some(lambda)) => format!("{lambda} next to walls, odd rates at least {wall:.3}"),
            (None, None) => "as the collision operator has it".into(),
        };
        if let (None, Some(lambda)) = (n.lambda, n.solid_lambda) {
            magic += &format!("; {lambda} next to solids, odd rates at least {solid:.3}");
        }
        lines.add("Λ", magic);
    }
}

impl Kernel {
    /// Work of one invocation, and of all invocations of a step.
    fn work(&self) -> String {
        let all = f64::from(self.workgroups) * f64::from(self.invocations);
        let open = match self.loops {
            0 => String::new(),
            n => format!("; one iteration of each of {n} loops is counted"),
        };
        format!(
            "per invocation: {} flop, {} B read, {} B written at most; all: {:.3e} flop, {}{open}",
            self.flops,
            self.read,
            self.written,
            all * self.flops as f64,
            bytes((all * (self.read + self.written) as f64) as u64),
        )
    }
}

/// The names; consecutively numbered ones are shortened to the first and the last.
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
