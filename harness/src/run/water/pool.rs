//! A run of water in numbers.

use super::Pond;
use serde::Serialize;
use std::{fmt, time::Duration};

/// What the particles of water did.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Pool {
    /// Particles of water at the start.
    pub particles: u32,
    /// Shell particles of walls and blocks.
    pub shell: u32,
    /// Particles that have left through open faces.
    pub escaped: u32,
    /// Distance of particles, m.
    pub spacing: f64,
    /// Mass of one, kg.
    pub particle_mass: f64,
    /// Speed of sound, m/s.
    pub sound_speed: f64,
    /// Acoustic steps that the water has taken, those before a restart included.
    pub acoustic_steps: u64,
    /// Those of this run.
    pub steps_here: u64,
    /// Those of this run that sorted the particles.
    pub sorts: u64,
    /// How often water and blocks met in this run.
    pub exchanges: u64,
    /// Largest speed that was seen, m/s.
    pub max_speed: f64,
    /// Largest Mach number that was seen.
    pub max_mach: f64,
    /// Updates of particles of water a second, without what was written.
    pub updates_a_second: f64,
}

impl Pool {
    /// The water of `pond` as far as it is known now.
    pub fn of(pond: &Pond) -> Self {
        let particles = pond.simulation.particles();
        let (setup, numbers) = (particles.setup(), particles.numbers());
        Self {
            particles: numbers.water,
            shell: numbers.shell,
            escaped: particles.escaped(),
            spacing: setup.spacing,
            particle_mass: setup.particle_mass(),
            sound_speed: setup.sound_speed,
            acoustic_steps: particles.steps(),
            steps_here: 0,
            sorts: pond.simulation.sorts(),
            exchanges: pond.simulation.exchanges(),
            max_speed: pond.fastest,
            max_mach: pond.fastest / setup.sound_speed,
            updates_a_second: 0.0,
        }
    }

    /// The same with the speed since `first`, in the `time` that steps have taken.
    pub fn since(self, first: Option<&Self>, time: Duration) -> Self {
        let steps = self.acoustic_steps - first.map_or(0, |first| first.acoustic_steps);
        let updates = steps as f64 * f64::from(self.particles - self.escaped);
        Self {
            steps_here: steps,
            updates_a_second: updates / time.as_secs_f64().max(1e-9),
            ..self
        }
    }
}

impl fmt::Display for Pool {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "  {} particles of water, {} of shells; {} left through open faces",
            self.particles, self.shell, self.escaped
        )?;
        write!(
            f,
            "  {} acoustic steps, {} exchanges; {:.2} million particle updates/s; speed at most {:.3e} m/s, Mach {:.3}",
            self.acoustic_steps,
            self.exchanges,
            self.updates_a_second / 1e6,
            self.max_speed,
            self.max_mach
        )
    }
}
