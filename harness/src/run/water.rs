//! Free water (SPH) in the summary of a run.

use super::{scene_run::SceneRun, throughput::Throughput};
use glam::DVec3;
use riprap::{
    coupling::Rock,
    scene::Boundary,
    simulation::WaterLedger,
    sph::{Scheme, SphSolver},
};
use serde::Serialize;
use std::fmt;

/// Mach number above which density changes by several percent.
const MAX_MACH: f64 = 0.2;

/// Tolerated fraction of escaped particles in a domain without an outlet.
const MAX_ESCAPED_FRACTION: f64 = 0.01;

/// Particles, steps and speeds of a run.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct WaterSummary {
    /// Fluid particles at the start.
    pub particles: u32,
    /// Boundary particles of walls and blocks.
    pub shell: u32,
    /// Particles that have left the domain.
    pub escaped: u32,
    /// Particle spacing, m.
    pub spacing: f64,
    /// Mass of a particle, kg.
    pub particle_mass: f64,
    /// Speed of sound, m/s.
    pub sound_speed: f64,
    /// Acoustic steps since the start of the scene.
    pub acoustic_steps: u64,
    /// Acoustic steps of this run.
    pub steps_here: u64,
    /// Acoustic steps of this run that sorted the particles.
    pub sorts: u64,
    /// Exchanges between water and blocks in this run.
    pub exchanges: u64,
    /// Largest speed at the start or after any acoustic step of this run, m/s.
    pub max_speed: f64,
    /// Its Mach number.
    pub max_mach: f64,
    /// Updates per second of fluid particles in the domain and of boundary particles, whose pressure is computed in each step,
    /// without output and without the first steps, in which drivers compile the kernels.
    pub updates_a_second: f64,
}

impl WaterSummary {
    /// The present summary of the free water of `run`, if there is any.
    pub fn of(run: &SceneRun) -> Option<Self> {
        let particles = run.simulation.particles()?;
        let (setup, counts) = (particles.setup(), particles.counts());
        // The solver reports the speeds after steps only; the readbacks include the start.
        let max_speed = run.max_water_speed.max(particles.max_speed());
        let exchanges = run.simulation.rock().map(Rock::exchange_count);
        Some(Self {
            particles: counts.fluid,
            shell: counts.boundary,
            escaped: particles.escaped(),
            spacing: setup.spacing,
            particle_mass: setup.particle_mass(),
            sound_speed: setup.sound_speed,
            acoustic_steps: particles.steps(),
            steps_here: 0,
            sorts: run.simulation.sorts(),
            exchanges: exchanges.unwrap_or_default(),
            max_speed,
            max_mach: max_speed / setup.sound_speed,
            updates_a_second: 0.0,
        })
    }

    /// The summary of the steps since `first`, with the update rate.
    pub fn since(self, first: Option<&Self>, throughput: &Throughput) -> Self {
        let steps = self.acoustic_steps - first.map_or(0, |first| first.acoustic_steps);
        let particles = u64::from(self.particles - self.escaped) + u64::from(self.shell);
        let warm = throughput.warm();
        Self {
            steps_here: steps,
            updates_a_second: warm.rate(warm.fluid_steps * particles),
            ..self
        }
    }
}

impl WaterSummary {
    /// Warnings about the results of `run`.
    pub fn warnings(&self, run: &SceneRun) -> Vec<String> {
        let mut warnings = Vec::new();
        let Some(setup) = run.simulation.particles().map(SphSolver::setup) else {
            return warnings;
        };
        // The scheme of Mueller has Mach 0.45 at the largest expected speed by design.
        if setup.scheme == Scheme::Delta && self.max_mach > MAX_MACH {
            warnings.push(format!(
                "water reached {:.3} m/s, Mach {:.2}, and its density changes by several percent above Mach {MAX_MACH}; \
                 set particles.largest_speed to that speed, or check for water that leaks or is squeezed",
                self.max_speed, self.max_mach
            ));
        }
        let fraction = f64::from(self.escaped) / f64::from(self.particles.max(1));
        if fraction > MAX_ESCAPED_FRACTION && !has_outlet(run, setup.gravity) {
            warnings.push(format!(
                "{} of {} particles ({:.1} %) left the domain, which has no open face below or at the sides; check for a \
                 leak, or for water that splashes out",
                self.escaped,
                self.particles,
                100.0 * fraction
            ));
        }
        warnings
    }
}

/// Whether the domain has an open face through which water flows out; through faces above only drops escape.
fn has_outlet(run: &SceneRun, gravity: DVec3) -> bool {
    let mut faces = run.simulation.scene().boundaries.iter();
    faces.any(|(face, boundary)| {
        let down = face.outward() * gravity[face.axis().index()];
        *boundary == Boundary::Open && down >= 0.0
    })
}

impl fmt::Display for WaterSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "  {} fluid particles, {} boundary particles; {} have left the domain",
            self.particles, self.shell, self.escaped
        )?;
        write!(
            f,
            "  {} acoustic steps, {} exchanges; {:.2} million particle updates/s, boundary particles included; speed at most \
             {:.3e} m/s, Mach {:.3}",
            self.acoustic_steps,
            self.exchanges,
            self.updates_a_second / 1e6,
            self.max_speed,
            self.max_mach
        )
    }
}

/// Changes of the energy of the water since the start of the scene, and work since then, J.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Energies {
    /// Gain of kinetic energy.
    pub kinetic: f64,
    /// Gain of potential energy of the particles inside the domain.
    pub potential: f64,
    /// Gain of compression energy.
    pub compression: f64,
    /// Energy of the escaped particles, with the potential energy relative to the origin.
    pub left: f64,
    /// Work of free and driven blocks.
    pub bodies: f64,
    /// Work of the penalty force of solids and fixed blocks.
    pub pushed: f64,
    /// Work of boundary particles beyond the work of their walls and blocks: the error of this boundary condition.
    pub pressed: f64,
    /// Dissipated energy, with the error of the time integration.
    pub dissipated: f64,
    /// Work of blocks on the water and in joints, computed from their own motion.
    pub blocks: f64,
    /// Work of blocks in joints that have no particles.
    pub joints: f64,
    /// Work of blocks on the water that it did not receive.
    pub unmatched: f64,
}

impl Energies {
    /// The balance of a ledger since the start.
    pub fn of(ledger: WaterLedger) -> Self {
        Self {
            kinetic: ledger.kinetic,
            potential: ledger.potential,
            compression: ledger.compression,
            left: ledger.escaped,
            bodies: ledger.bodies,
            pushed: ledger.penalty,
            pressed: ledger.boundary,
            dissipated: ledger.dissipated(),
            blocks: ledger.blocks,
            joints: ledger.joints,
            unmatched: ledger.unmatched(),
        }
    }
}

impl fmt::Display for Energies {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "  energy of the water: kinetic {:+.4e} J, potential {:+.4e} J, compression {:+.2e} J, escaped {:+.2e} J; \
             work of blocks {:+.4e} J, of the penalty force {:+.2e} J, of boundary particles {:+.2e} J; dissipated {:.4e} J",
            self.kinetic,
            self.potential,
            self.compression,
            self.left,
            self.bodies,
            self.pushed,
            self.pressed,
            self.dissipated
        )?;
        if self.blocks == 0.0 && self.bodies == 0.0 {
            return Ok(());
        }
        write!(
            f,
            "\n  work of blocks {:.4e} J, {:.2e} J of it in joints; the water received {:.4e} J, difference {:.2e} J",
            self.blocks, self.joints, self.bodies, self.unmatched
        )
    }
}
