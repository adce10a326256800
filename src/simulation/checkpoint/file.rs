//! Checkpoint files: a header of [`MAGIC`], the version and the [`Kind`](super::Kind), the state in
//! [postcard](https://docs.rs/postcard), and the CRC-32 (IEEE 802.3) of all preceding bytes.

use super::Checkpoint;
use crate::{
    Error, Result,
    output::{failure, replace},
};
use crc32fast::Hasher;
use std::{
    io::{self, Write},
    path::Path,
};

/// First bytes of a file.
const MAGIC: &[u8; 17] = b"riprap checkpoint";
/// Version of the format, higher than the versions of the three formats before it.
const VERSION: u8 = 19;
/// First bytes of the formats before version 6; their version is the digit at [`OLD_VERSION`].
const OLD_MAGICS: [&[u8]; 3] = [b"riprap state ", b"riprap rocks ", b"riprap water "];
/// Offset of the version in the formats before version 6.
const OLD_VERSION: usize = 14;
/// Bytes of the header: magic, version, kind.
const HEADER: usize = MAGIC.len() + 2;
/// Bytes of the checksum.
const SUM: usize = 4;

impl Checkpoint {
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
    /// The errors of `file`.
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
        let damaged = "the checkpoint is cut short or damaged: its checksum does not match; use an older one, or \
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
}

/// A writer that updates the checksum with the written bytes and keeps the error of a failed write.
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
    use crate::{
        geometry::Load,
        rock::Snapshot,
        simulation::checkpoint::WaterState,
        sph::{Particle, SphState},
    };
    use glam::DVec3;

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
        let folder = tempfile::tempdir().expect("a folder to write to");
        let path = folder.path().join("checkpoint.riprap");
        checkpoint().write(&path).expect("a folder to write to");
        assert_eq!(Checkpoint::read(&path).expect("a checkpoint"), checkpoint());
        let whole = std::fs::read(&path).expect("the file");
        let changed = |at: usize, to: u8| {
            let mut bytes = whole.clone();
            bytes[at] = to;
            bytes
        };
        // Another version stays refused however old the file.
        let next = format!("version {}", VERSION + 1);
        for (bytes, version) in [
            (changed(MAGIC.len(), VERSION + 1), next.as_str()),
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
