//! A run of water in numbers.

use super::Pond;
use riprap::{particles::Scheme, scene::Boundary};
use serde::Serialize;
use std::{fmt, time::Duration};

/// Mach number above which density changes by several hundredths.
const FAST: f64 = 0.2;

/// Share of the water that may leave where none is meant to.
const LOST: f64 = 0.01;

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
    /// Largest speed at the start or after any acoustic step of this run, m/s.
    pub max_speed: f64,
    /// Its Mach number.
    pub max_mach: f64,
    /// Updates of particles of water a second, without what was written.
    pub updates_a_second: f64,
}

impl Pool {
    /// The water of `pond` as far as it is known now.
    pub fn of(pond: &Pond) -> Self {
        let particles = pond.simulation.particles();
        let (setup, numbers) = (particles.setup(), particles.numbers());
        // The start is no step.
        let max_speed = pond.fastest.max(particles.fastest());
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
            max_speed,
            max_mach: max_speed / setup.sound_speed,
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

impl Pool {
    /// What makes the numbers of `pond` doubtful.
    pub fn warnings(&self, pond: &Pond) -> Vec<String> {
        let mut warnings = Vec::new();
        let setup = pond.simulation.particles().setup();
        // The published scheme has Mach 0.45 at the largest speed expected.
        if setup.scheme == Scheme::Delta && self.max_mach > FAST {
            warnings.push(format!(
                "water reached {:.3} m/s, Mach {:.2}, and its density changes by several hundredths above Mach {FAST}; \
                 give particles.largest_speed that speed, or look for water that leaks or is squeezed",
                self.max_speed, self.max_mach
            ));
        }
        let share = f64::from(self.escaped) / f64::from(self.particles.max(1));
        if share > LOST && !has_outlet(pond) {
            warnings.push(format!(
                "{} of {} particles ({:.1} %) left the domain, which is open neither below nor beside the water; look for \
                 a leak, or for water that is thrown out",
                self.escaped,
                self.particles,
                100.0 * share
            ));
        }
        warnings
    }
}

/// Whether water may leave through a face: those above it only let drops out.
fn has_outlet(pond: &Pond) -> bool {
    let gravity = pond.simulation.particles().setup().gravity;
    let mut faces = pond.simulation.scene().boundaries.iter();
    faces.any(|(face, boundary)| {
        let down = face.outward() * gravity[face.axis().index()];
        *boundary == Boundary::Open && down >= 0.0
    })
}

impl fmt::Display for Pool {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "  {} particles of water, {} of shells; {} have left the domain",
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
