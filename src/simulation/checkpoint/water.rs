//! Free water and the blocks in it on disk.

#[cfg(feature = "checkpoint")]
use super::sealed;
use crate::{
    Error, Result,
    geometry::Load,
    rock::Snapshot,
    simulation::Reading,
    sph::{ExternalWork, Particle, SphState},
};
use glam::{DMat3, DVec3};
use std::path::Path;

/// The state of free water and its blocks between two steps.
#[derive(Clone, Debug, PartialEq)]
pub struct WaterCheckpoint {
    /// Steps done.
    pub step: u64,
    /// Length of a step, s.
    pub time_step: f64,
    /// Lower corner of the domain, m.
    pub origin: DVec3,
    /// Its size, m.
    pub size: DVec3,
    /// Spacing of the particles, m.
    pub spacing: f64,
    /// The particles, in the order and the units of the device.
    pub particles: Vec<Particle>,
    /// What the water remembers besides.
    pub state: SphState,
    /// Mean load on each block in the last exchange; none before the first one.
    pub loads: Vec<Load>,
    /// What blocks gave up since the start in joints that have no water, J.
    pub joints: f64,
    /// What blocks gave up to all of their water, J.
    pub given: f64,
    /// What pressure sensors have felt.
    pub sensors: Vec<Reading>,
    /// The blocks.
    pub blocks: Snapshot,
}

/// First bytes of a file; the digit is the version of the format.
#[cfg(feature = "checkpoint")]
const MAGIC: &sealed::Magic = b"riprap water  5\n";
/// Words of eight bytes after them: step, time step, particles, limit, escaped, steps of the water, length of the
/// last exchange, velocities, loads, lower corner and size of the domain, spacing, works of bodies, pushes, dummy
/// particles, joints and blocks, sensors.
const WORDS: usize = 22;
/// Bytes of a particle.
const PARTICLE: usize = size_of::<Particle>();
/// Numbers of a body: a vector and a matrix.
const BODY: usize = 12;

#[cfg(feature = "checkpoint")]
impl WaterCheckpoint {
    /// Writes the file; one that is there stays whole until the new one is complete.
    ///
    /// # Errors
    /// [`Error::File`] if it cannot be written.
    pub fn write(&self, path: &Path) -> Result<()> {
        let state = &self.state;
        let [origin, size] = [self.origin, self.size].map(|v| v.to_array().map(f64::to_bits));
        let words = [
            self.step,
            self.time_step.to_bits(),
            self.particles.len() as u64,
            state.step_limit.to_bits().into(),
            state.escaped.into(),
            state.steps,
            state.last_duration.to_bits(),
            state.previous_rates.len() as u64,
            self.loads.len() as u64,
            origin[0],
            origin[1],
            origin[2],
            size[0],
            size[1],
            size[2],
            self.spacing.to_bits(),
            state.work.bodies.to_bits(),
            state.work.penalty.to_bits(),
            state.work.boundary.to_bits(),
            self.joints.to_bits(),
            self.given.to_bits(),
            self.sensors.len() as u64,
        ];
        let loads = self.loads.iter().map(|load| (load.force, load.moment));
        let bodies = state.previous_rates.iter().copied().chain(loads);
        sealed::write(path, MAGIC, |file| {
            for word in words {
                file.write_all(&word.to_le_bytes())?;
            }
            for particle in &self.particles {
                let words: [u32; PARTICLE / 4] = bytemuck::cast(*particle);
                file.write_all(words.map(u32::to_le_bytes).as_flattened())?;
            }
            for (vector, matrix) in bodies {
                for number in vector.to_array().into_iter().chain(matrix.to_cols_array()) {
                    file.write_all(&number.to_le_bytes())?;
                }
            }
            for sensor in &self.sensors {
                file.write_all(&sensor.pressure.to_le_bytes())?;
                file.write_all(&sensor.impulse.to_le_bytes())?;
            }
            file.write_all(&self.blocks.to_bytes())
        })
    }

    /// Reads a file.
    ///
    /// # Errors
    /// [`Error::File`] if it cannot be read, is no checkpoint of free water, or is not as it was written.
    pub fn read(path: &Path) -> Result<Self> {
        let bytes = sealed::read(path, MAGIC, "free water")?;
        let mut reader = Reader { rest: &bytes, path };
        let words = reader.take(WORDS, 8)?;
        let word = |n: usize| u64::from_le_bytes(std::array::from_fn(|k| words[8 * n + k]));
        let vector =
            |n: usize| DVec3::from_array([n, n + 1, n + 2].map(|n| f64::from_bits(word(n))));
        let count = |n: usize| usize::try_from(word(n)).unwrap_or(usize::MAX);
        let particles = reader.take(count(2), PARTICLE)?;
        let particles = particles.chunks_exact(PARTICLE).map(|row| {
            let word = |n: usize| u32::from_le_bytes(std::array::from_fn(|k| row[4 * n + k]));
            bytemuck::cast::<[u32; PARTICLE / 4], Particle>(std::array::from_fn(word))
        });
        let particles = particles.collect();
        let previous_rates = reader.bodies(count(7))?;
        let loads = reader.bodies(count(8))?;
        let sensors = reader.take(count(21), 16)?;
        let sensors = sensors.chunks_exact(16).map(|row| {
            let number = |n: usize| f64::from_le_bytes(std::array::from_fn(|k| row[8 * n + k]));
            Reading {
                pressure: number(0),
                impulse: number(1),
            }
        });
        let sensors = sensors.collect();
        let load = |(force, moment)| Load {
            force,
            moment,
            ..Load::default()
        };
        Ok(Self {
            step: word(0),
            time_step: f64::from_bits(word(1)),
            origin: vector(9),
            size: vector(12),
            spacing: f64::from_bits(word(15)),
            particles,
            state: SphState {
                step_limit: f32::from_bits(word(3) as u32),
                escaped: word(4) as u32,
                steps: word(5),
                last_duration: f64::from_bits(word(6)),
                previous_rates,
                work: ExternalWork {
                    bodies: f64::from_bits(word(16)),
                    penalty: f64::from_bits(word(17)),
                    boundary: f64::from_bits(word(18)),
                },
            },
            joints: f64::from_bits(word(19)),
            given: f64::from_bits(word(20)),
            sensors,
            loads: loads.into_iter().map(load).collect(),
            blocks: Snapshot::from_bytes(reader.rest).map_err(|error| match error {
                Error::Argument { message, .. } => Error::file(path, message),
                other => other,
            })?,
        })
    }
}

/// The bytes of a file that have not been read.
struct Reader<'a> {
    rest: &'a [u8],
    path: &'a Path,
}

impl<'a> Reader<'a> {
    /// `count` things of `size` bytes.
    fn take(&mut self, count: usize, size: usize) -> Result<&'a [u8]> {
        let parts = count
            .checked_mul(size)
            .and_then(|bytes| self.rest.split_at_checked(bytes));
        let Some((head, tail)) = parts else {
            let message = "the checkpoint is cut short; use an older one";
            return Err(Error::file(self.path, message));
        };
        self.rest = tail;
        Ok(head)
    }

    fn bodies(&mut self, count: usize) -> Result<Vec<(DVec3, DMat3)>> {
        let rows = self.take(count, 8 * BODY)?.chunks_exact(8 * BODY);
        let body = |row: &[u8]| {
            let number = |n: usize| f64::from_le_bytes(std::array::from_fn(|k| row[8 * n + k]));
            let matrix: [f64; 9] = std::array::from_fn(|n| number(3 + n));
            let vector = DVec3::new(number(0), number(1), number(2));
            (vector, DMat3::from_cols_array(&matrix))
        };
        Ok(rows.map(body).collect())
    }
}
