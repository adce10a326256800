//! Report on a scene of particles.

use super::{BlockFacts, lines::Lines, trial::Trial};
use crate::{
    adapters::Adapter,
    print::{bytes, duration, time},
    run::SceneRun,
};
use riprap::sph::{Particle, ReferencePosition};
use serde::Serialize;

/// What `riprap check` reports on particles.
#[derive(Debug, Serialize)]
pub struct WaterReport {
    /// Title of the scene.
    pub title: String,
    /// The adapter on which it runs.
    pub adapter: Adapter,
    /// Particles of water.
    pub particles: u32,
    /// Boundary particles.
    pub shell: u32,
    /// Bytes of all particles on the device.
    pub memory: u64,
    /// Particle spacing, m.
    pub spacing: f64,
    /// Mass of a particle, kg.
    pub particle_mass: f64,
    /// Mass of the water, kg.
    pub mass: f64,
    /// Largest expected speed, m/s.
    pub largest_speed: f64,
    /// Speed of sound, m/s.
    pub sound_speed: f64,
    /// Mach number at the largest speed.
    pub mach: f64,
    /// Longest acoustic step, s.
    pub acoustic_step: f64,
    /// Step of the run, s.
    pub time_step: f64,
    /// Steps of the run.
    pub steps: u64,
    /// Simulated time of the run, s.
    pub duration: f64,
    /// The blocks, if there are any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub blocks: Option<BlockFacts>,
    /// Warnings about the scene.
    pub warnings: Vec<String>,
    /// Time that one step takes, s.
    pub step_seconds: f64,
    /// Time that the run takes without its output, s.
    pub run_seconds: f64,
    /// Updates of fluid and boundary particles per second.
    pub particles_a_second: f64,
    /// Steps of the trial.
    pub trial_steps: u64,
}

/// Runs a few steps of a scene of free water. Returns how the trial ended, and a report if the scene has water.
pub fn report(run: &mut SceneRun, adapter: Adapter) -> (Option<WaterReport>, riprap::Result<()>) {
    let steps = run.scene().run.count(run.time_step());
    let trial = Trial::of(run);
    let (done, step) = (trial.steps, trial.step());
    let report = run.simulation.particles().map(|particles| {
        let (setup, counts) = (particles.setup(), particles.counts());
        let all = u64::from(counts.fluid) + u64::from(counts.boundary);
        // The step before the trial took as many acoustic steps as each of the trial.
        let tried = particles.steps() as f64 * done as f64 / (done + 1) as f64;
        let updates = tried * all as f64;
        let left_out = run.simulation.rock().map(|rock| &*rock.setup().left_out);
        WaterReport {
            title: run.scene().title.clone(),
            adapter,
            particles: counts.fluid,
            shell: counts.boundary,
            // Unsorted and sorted particles, and reference positions of boundary particles.
            memory: 2 * all * size_of::<Particle>() as u64
                + u64::from(counts.boundary) * size_of::<ReferencePosition>() as u64,
            spacing: setup.spacing,
            particle_mass: setup.particle_mass(),
            mass: setup.particle_mass() * f64::from(counts.fluid),
            largest_speed: setup.largest_speed(),
            sound_speed: setup.sound_speed,
            mach: setup.largest_speed() / setup.sound_speed,
            acoustic_step: setup.acoustic_step(),
            time_step: run.time_step(),
            steps,
            duration: run.scene().run.length(run.time_step()),
            blocks: run.rock().map(|rock| {
                let shown = &rock.setup.blocks[..rock.shown];
                let left_out = left_out.unwrap_or_default();
                BlockFacts::of(shown, rock.blocks, left_out, run.time_step())
            }),
            warnings: run.warnings.clone(),
            step_seconds: step,
            run_seconds: step * steps as f64,
            particles_a_second: updates / trial.seconds.max(1e-9),
            trial_steps: done,
        }
    });
    (report, trial.ended)
}

impl WaterReport {
    /// The report, one line per item.
    pub fn text(&self) -> String {
        let mut lines = Lines::titled(&self.title);
        lines.adapter(&self.adapter);
        lines.add(
            "water",
            format_args!(
                "{} particles of {:.4e} m, {:.4e} kg each, {:.4e} kg in all; {} boundary particles",
                self.particles, self.spacing, self.particle_mass, self.mass, self.shell
            ),
        );
        lines.add(
            "memory",
            format_args!("{} of particles", bytes(self.memory)),
        );
        lines.add(
            "sound",
            format_args!(
                "{:.3} m/s, Mach {:.2} at the largest speed expected, {:.3} m/s",
                self.sound_speed, self.mach, self.largest_speed
            ),
        );
        if let Some(blocks) = &self.blocks {
            blocks.lines(&mut lines);
        }
        lines.add(
            "time",
            format_args!(
                "{} steps of {:.4e} s = {}; acoustic steps of at most {:.4e} s",
                self.steps,
                self.time_step,
                time(self.duration, 4),
                self.acoustic_step
            ),
        );
        lines.warnings(&self.warnings);
        lines.add(
            "run",
            format_args!(
                "about {} without output: {:.3e} s per step, {:.2} million particle updates per second, boundary particles included ({} steps tried)",
                duration(self.run_seconds),
                self.step_seconds,
                self.particles_a_second / 1e6,
                self.trial_steps
            ),
        );
        lines.text()
    }
}
