//! The state of a simulation between two steps, and its file.
//!
//! A file has a header ([`MAGIC`], the version, the [`Kind`]), the state in [postcard](https://docs.rs/postcard), and the
//! CRC-32 (IEEE 802.3) of all of that. Arrays of the device are in canonical order, so that they restart under any storage,
//! lanes or bindings.

use crate::{
    Error, Result,
    coupling::{CouplingState, RockState},
    geometry::Load,
    gpu::plain_bytes,
    lattice::{Inside, Populations},
    output::{failure, replace},
    scene::Scene,
    simulation::Reading,
    sph::{Particle, SphState},
};
use crc32fast::Hasher;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::{
    fmt,
    io::{self, Write},
    path::Path,
};

/// First bytes of a file.
const MAGIC: &[u8; 17] = b"riprap checkpoint";
/// Version of the format, above those of the three formats before it.
const VERSION: u8 = 6;
/// First bytes of the formats before version 6; their version is the digit at [`OLD_VERSION`].
const OLD_MAGICS: [&[u8]; 3] = [b"riprap state ", b"riprap rocks ", b"riprap water "];
/// Place of the version in the formats before version 6.
const OLD_VERSION: usize = 14;
/// Bytes of the header: magic, version, kind.
const HEADER: usize = MAGIC.len() + 2;
/// Bytes of the checksum.
const SUM: usize = 4;

/// What a simulation consists of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Blocks without a fluid.
    Rock,
    /// A fluid on a lattice, with or without blocks.
    Lattice,
    /// Free water (SPH), with or without blocks.
    Particles,
}

impl Kind {
    /// The kind of a scene.
    pub fn of(scene: &Scene) -> Self {
        if scene.has_particles() {
            Self::Particles
        } else if scene.has_fluid() {
            Self::Lattice
        } else {
            Self::Rock
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Rock => "blocks alone",
            Self::Lattice => "a fluid on a lattice",
            Self::Particles => "free water",
        })
    }
}

/// The state of a simulation between two steps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    /// Steps done.
    pub step: u64,
    /// Length of a step, s.
    pub time_step: f64,
    /// The blocks, if there are any.
    pub rock: Option<RockState>,
    /// The fluid, if there is one.
    pub fluid: Option<FluidState>,
}

/// The state of a fluid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum FluidState {
    /// On a lattice.
    Lattice(LatticeState),
    /// Free water.
    Particles(WaterState),
}

/// The state of a fluid on a lattice.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LatticeState {
    /// Cell size, m.
    pub cell: f64,
    /// The populations.
    pub populations: Populations,
    /// Velocities where blocks are, which nothing of the next step depends on.
    pub inside: Inside,
    /// The coupling to blocks, if there are any.
    pub coupling: Option<CouplingState>,
}

/// The state of free water.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WaterState {
    /// Lower corner of the domain, m.
    pub origin: DVec3,
    /// Its size, m.
    pub size: DVec3,
    /// Spacing of the particles, m.
    pub spacing: f64,
    /// The particles, in the order and the units of the device.
    #[serde(with = "plain_bytes")]
    pub particles: Vec<Particle>,
    /// State of the solver besides.
    pub solver: SphState,
    /// Mean load on each block in the last exchange; empty before the first one.
    pub loads: Vec<Load>,
    /// Work of blocks since the start in joints that have no particles, J.
    pub joints: f64,
    /// Measurements of the pressure sensors.
    pub sensors: Vec<Reading>,
}

impl Checkpoint {
    /// What the simulation consists of.
    pub fn kind(&self) -> Kind {
        match self.fluid {
            None => Kind::Rock,
            Some(FluidState::Lattice(_)) => Kind::Lattice,
            Some(FluidState::Particles(_)) => Kind::Particles,
        }
    }

    /// Writes the file. An existing file is kept until the new one is complete.
    ///
    /// # Errors
    /// [`Error::File`] if it cannot be written.
    pub fn write(&self, path: &Path) -> Result<()> {
        replace(path, |file| self.write_to(file))
    }

    /// Writes the bytes of a file.
    ///
    /// # Errors
    /// Those of `file`.
    pub fn write_to(&self, file: &mut dyn Write) -> io::Result<()> {
        let mut file = Summed {
            file,
            sum: Hasher::new(),
            failed: None,
        };
        file.write_all(MAGIC)?;
        file.write_all(&[VERSION, self.kind() as u8])?;
        if let Err(error) = postcard::to_io(self, &mut file) {
            // Postcard does not say why a write failed.
            return Err(file.failed.unwrap_or_else(|| io::Error::other(error)));
        }
        let sum = file.sum.finalize();
        file.file.write_all(&sum.to_le_bytes())
    }

    /// Reads a file.
    ///
    /// # Errors
    /// [`Error::File`] if it cannot be read, is no checkpoint, has another version, or is truncated or damaged.
    pub fn read(path: &Path) -> Result<Self> {
        let bytes = std::fs::read(path).map_err(|error| failure("read", path, &error))?;
        let refused = |message: String| Err(Error::file(path, message));
        let other_version = |version: String| {
            refused(format!(
                "this checkpoint has version {version} of its format, and this riprap reads version {VERSION}; go on with \
                 the riprap that wrote it, or run the scene from its start"
            ))
        };
        if OLD_MAGICS.iter().any(|magic| bytes.starts_with(magic)) {
            let version = bytes.get(OLD_VERSION).map_or('?', |&digit| digit.into());
            return other_version(version.to_string());
        }
        let damaged = "the checkpoint is cut short or damaged: its checksum is not that of its bytes; use an older one, or \
                       run the scene from its start";
        let Some(rest) = bytes.strip_prefix(MAGIC) else {
            return refused(
                if bytes.starts_with(b"riprap ") && MAGIC.starts_with(&bytes) {
                    damaged
                } else {
                    "this is not a checkpoint; give the checkpoint.riprap that a run wrote"
                }
                .into(),
            );
        };
        if let Some(version) = rest.first().filter(|version| **version != VERSION) {
            return other_version(version.to_string());
        }
        let Some((content, sum)) = bytes.split_last_chunk::<SUM>() else {
            return refused(damaged.into());
        };
        if content.len() < HEADER || *sum != crc32fast::hash(content).to_le_bytes() {
            return refused(damaged.into());
        }
        match postcard::take_from_bytes::<Self>(&content[HEADER..]) {
            Ok((read, [])) if content[HEADER - 1] == read.kind() as u8 => Ok(read),
            _ => refused(
                "the checkpoint is not one that this riprap writes; run the scene from its start"
                    .into(),
            ),
        }
    }

    /// Checks that it is of a simulation of the same kind and time step.
    ///
    /// # Errors
    /// [`Error::Scene`] if not.
    pub(super) fn check(&self, kind: Kind, time_step: f64) -> Result<()> {
        if self.kind() != kind {
            return Err(other_scene(self.kind(), kind));
        }
        if differ(self.time_step, time_step) {
            return Err(other_scene(
                format!("steps of {:e} s", self.time_step),
                format!("steps of {time_step:e} s"),
            ));
        }
        Ok(())
    }
}

/// Whether two lengths differ by more than rounding.
pub(super) fn differ(its: f64, own: f64) -> bool {
    (its - own).abs() > 1e-12 * own
}

/// The error of a checkpoint that is of something else than the scene.
pub(super) fn other_scene(its: impl fmt::Display, own: impl fmt::Display) -> Error {
    Error::scene(
        "restart",
        format!(
            "the checkpoint is of {its}, and the scene of {own}; restart with the scene that wrote it"
        ),
    )
}

/// Sums the bytes that pass, and keeps the error of a write.
struct Summed<'a> {
    file: &'a mut dyn Write,
    sum: Hasher,
    failed: Option<io::Error>,
}

impl Write for Summed<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self.file.write(bytes) {
            Ok(written) => {
                self.sum.update(&bytes[..written]);
                Ok(written)
            }
            Err(error) if error.kind() == io::ErrorKind::Interrupted => Err(error),
            Err(error) => {
                let again = error.raw_os_error().map(io::Error::from_raw_os_error);
                self.failed = Some(again.unwrap_or_else(|| error.kind().into()));
                Err(error)
            }
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rock::Snapshot;

    fn checkpoint() -> Checkpoint {
        Checkpoint {
            step: 1,
            time_step: 0.1,
            rock: None,
            fluid: None,
        }
    }

    /// The error of a file with these bytes.
    fn refusal(path: &Path, bytes: &[u8]) -> String {
        std::fs::write(path, bytes).expect("a folder to write to");
        Checkpoint::read(path)
            .expect_err("it is damaged")
            .to_string()
    }

    #[test]
    fn files_of_other_versions_and_damaged_ones_are_refused() {
        let name = format!("riprap_refused_{}.checkpoint", std::process::id());
        let path = std::env::temp_dir().join(name);
        checkpoint().write(&path).expect("a folder to write to");
        assert_eq!(Checkpoint::read(&path).expect("a checkpoint"), checkpoint());
        let whole = std::fs::read(&path).expect("the file");
        let changed = |at: usize, to: u8| {
            let mut bytes = whole.clone();
            bytes[at] = to;
            bytes
        };
        // Another version stays refused however old the file.
        for (bytes, version) in [
            (changed(MAGIC.len(), 7), "version 7"),
            (b"riprap state  4\nrest".to_vec(), "version 4"),
            (b"riprap rocks  2\n".to_vec(), "version 2"),
            (b"riprap water  5\n".to_vec(), "version 5"),
        ] {
            let error = refusal(&path, &bytes);
            assert!(
                error.contains(version) && !error.contains("older"),
                "{error}"
            );
        }
        for bytes in [
            &whole[..whole.len() - 1],
            &whole[..HEADER],
            &whole[..10],
            &changed(MAGIC.len() + 1, 1),
            &changed(HEADER, 2),
        ] {
            let error = refusal(&path, bytes);
            assert_eq!(error.matches("use an older").count(), 1, "{error}");
        }
        let error = refusal(&path, b"<VTKFile>");
        assert!(error.contains("not a checkpoint"), "{error}");
        std::fs::remove_file(&path).expect("the file");
    }

    /// All numbers keep their bits, NaN included.
    #[test]
    fn states_keep_their_bits() {
        let load = Load::at(DVec3::new(f64::NAN, -0.0, 1e-310), DVec3::X);
        let state = WaterState {
            origin: DVec3::ZERO,
            size: DVec3::ONE,
            spacing: 0.1,
            particles: vec![Particle::default(); 3],
            solver: SphState::default(),
            loads: vec![load],
            joints: f64::from_bits(0x7ff8_0000_0000_1234),
            sensors: Vec::new(),
        };
        let bytes = postcard::to_allocvec(&state).expect("a state");
        let read: WaterState = postcard::from_bytes(&bytes).expect("a state");
        assert_eq!(read.joints.to_bits(), state.joints.to_bits());
        assert_eq!(postcard::to_allocvec(&read).expect("a state"), bytes);
        let empty = postcard::to_allocvec(&Snapshot::default()).expect("a snapshot");
        assert!(postcard::from_bytes::<Snapshot>(&empty[..empty.len() - 1]).is_err());
    }
}
