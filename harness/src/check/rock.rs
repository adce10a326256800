//! What a scene of blocks will run.

use crate::{
    print::{bytes, duration},
    search::{self, Finder, left_out},
};
use anyhow::Result;
use riprap::{
    block::{Form, Shape},
    bodies::Motion,
    scene::Scene,
    simulation::Dry,
};
use serde::Serialize;
use std::{
    collections::HashMap,
    fmt::Write,
    path::Path,
    sync::Arc,
    time::{Duration, Instant},
};

/// Length of the trial.
const TRIAL: Duration = Duration::from_millis(400);

/// All that `riprap check` says of blocks.
#[derive(Debug, Serialize)]
pub struct RockReport {
    /// Title of the scene.
    pub title: String,
    /// Blocks in all.
    pub blocks: usize,
    /// Those that forces move.
    pub free: usize,
    /// Those that formulas move.
    pub driven: usize,
    /// Those that nothing moves.
    pub fixed: usize,
    /// Different shapes.
    pub shapes: usize,
    /// Convex parts of all blocks.
    pub parts: usize,
    /// Spheres among them.
    pub spheres: usize,
    /// Faces of the others.
    pub faces: usize,
    /// Pieces of rock masses that are too small for a block, a line for each mass.
    pub left_out: Vec<String>,
    /// Mass of the free blocks, kg.
    pub mass: f64,
    /// Lightest free block: its name and mass, kg.
    pub lightest: Option<(String, f64)>,
    /// Pairs of parts that may touch at the start.
    pub pairs: usize,
    /// Contacts after the trial.
    pub contacts: usize,
    /// Where pairs are searched.
    pub search: String,
    /// Distance at which parts are candidates, m.
    pub skin: f64,
    /// Step of the run, s.
    pub time_step: f64,
    /// Longest sub-step after the trial, s.
    pub sub_step: f64,
    /// Sub-steps of a step.
    pub sub_steps: u64,
    /// Whether the scene gave the time step.
    pub given: bool,
    /// Steps of the run.
    pub steps: u64,
    /// Simulated time of the run, s.
    pub duration: f64,
    /// Bytes of the blocks' state and shapes, about.
    pub memory: u64,
    /// One step, s.
    pub step_seconds: f64,
    /// The run without its output, s.
    pub run_seconds: f64,
    /// Steps of the trial.
    pub trial_steps: u64,
}

/// Makes the blocks of `scene`, which was read from `file`, and tries a few steps.
///
/// # Errors
/// What the scene lacks.
pub fn report(scene: &Scene, file: &Path, adapter: Option<&str>) -> Result<RockReport> {
    let mut simulation = search::open(scene, file, adapter)?;
    let steps = scene.run.count(simulation.time_step());
    let (trial, spent) = try_out(&mut simulation, steps)?;
    let (setup, blocks) = (simulation.setup(), simulation.blocks());
    let count = |wanted: fn(&Motion) -> bool| {
        let motions = setup.blocks.iter().map(|block| &block.motion);
        motions.filter(|motion| wanted(motion)).count()
    };
    let shapes: HashMap<*const Shape, &Shape> = setup
        .blocks
        .iter()
        .map(|block| (Arc::as_ptr(&block.shape), &*block.shape))
        .collect();
    let parts = || setup.blocks.iter().flat_map(|block| block.shape.parts());
    let faces = |form: &Form| match form {
        Form::Convex(shape) => shape.faces().len(),
        Form::Sphere { .. } => 0,
    };
    let free: Vec<usize> = (0..blocks.len())
        .filter(|block| setup.blocks[*block].motion == Motion::Free)
        .collect();
    let mass = |block: &usize| blocks.mass(*block);
    let lightest = free.iter().min_by(|a, b| mass(a).total_cmp(&mass(b)));
    let step = spent / trial as f64;
    Ok(RockReport {
        title: scene.title.clone(),
        blocks: blocks.len(),
        free: free.len(),
        driven: count(|motion| matches!(motion, Motion::Driven { .. })),
        fixed: count(|motion| *motion == Motion::Fixed),
        shapes: shapes.len(),
        parts: parts().count(),
        spheres: parts()
            .filter(|part| matches!(part.form, Form::Sphere { .. }))
            .count(),
        faces: parts().map(|part| faces(&part.form)).sum(),
        left_out: left_out(simulation.left_out()).collect(),
        mass: free.iter().map(mass).sum(),
        lightest: lightest.map(|block| (blocks.name(*block).into(), mass(block))),
        pairs: blocks.candidates(),
        contacts: blocks.contacts().count(),
        search: simulation.finder().describe(),
        skin: blocks.skin(),
        time_step: simulation.time_step(),
        sub_step: blocks.time_step().min(simulation.time_step()),
        sub_steps: (simulation.time_step() / blocks.time_step() * (1.0 - 1e-12))
            .ceil()
            .max(1.0) as u64,
        given: scene.rock.time_step.is_some(),
        steps,
        duration: scene.run.length(simulation.time_step()),
        memory: blocks.snapshot().to_bytes().len() as u64
            + shapes.values().map(|shape| size(shape)).sum::<u64>(),
        step_seconds: step,
        run_seconds: step * steps as f64,
        trial_steps: trial,
    })
}

/// Bytes of a shape's faces, corners, edges and rings.
fn size(shape: &Shape) -> u64 {
    let parts = shape.parts().iter().map(|part| match &part.form {
        Form::Convex(block) => {
            let corners: usize = block.loops().iter().map(Vec::len).sum();
            size_of_val(block.faces())
                + size_of_val(block.vertices())
                + size_of_val(block.edges())
                + size_of_val(block.loops())
                + 4 * corners
        }
        Form::Sphere { .. } => 0,
    });
    parts.map(|bytes| bytes as u64).sum()
}

/// Steps for less than half a second, at least one: how many, and how long they took, s.
fn try_out(simulation: &mut Dry<Finder>, most: u64) -> Result<(u64, f64)> {
    // The first step finds all pairs and their contacts anew.
    search::drive(simulation, 1)?;
    let start = Instant::now();
    let mut done = 0;
    while done == 0 || (done < most && start.elapsed() < TRIAL) {
        search::drive(simulation, 1)?;
        done += 1;
    }
    Ok((done, start.elapsed().as_secs_f64()))
}

impl RockReport {
    /// The report in lines of a name and what there is of it.
    pub fn text(&self) -> String {
        let mut text = format!("{}\n", self.title);
        let mut line = |name: &str, what: String| {
            // A String takes all that is written to it.
            let _ = writeln!(text, "{name:12} {what}");
        };
        line(
            "blocks",
            format!(
                "{}: {} free, {} driven, {} fixed",
                self.blocks, self.free, self.driven, self.fixed
            ),
        );
        line(
            "shapes",
            format!(
                "{} different ones; {} convex parts, {} of them spheres; {} faces",
                self.shapes, self.parts, self.spheres, self.faces
            ),
        );
        for left_out in &self.left_out {
            line("left out", left_out.clone());
        }
        let lightest = self.lightest.as_ref();
        line(
            "mass",
            format!(
                "{:.4e} kg free{}",
                self.mass,
                lightest.map_or(String::new(), |(name, mass)| format!(
                    "; the lightest is {name} with {mass:.3e} kg"
                ))
            ),
        );
        line(
            "search",
            format!(
                "{}; {} pairs within {:.3e} m, {} contacts",
                self.search, self.pairs, self.skin, self.contacts
            ),
        );
        line(
            "time",
            format!(
                "{} steps of {:.4e} s = {:.4} s",
                self.steps, self.time_step, self.duration
            ),
        );
        line(
            "stability",
            match self.given {
                true => "the time step is the scene's; one too long is refused".into(),
                false => format!(
                    "{} sub-steps of at most {:.4e} s, half of the longest stable one",
                    self.sub_steps, self.sub_step
                ),
            },
        );
        line("memory", bytes(self.memory));
        line(
            "run",
            format!(
                "about {} without output: {:.3e} s a step ({} steps tried)",
                duration(self.run_seconds),
                self.step_seconds,
                self.trial_steps
            ),
        );
        text
    }
}
