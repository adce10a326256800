//! Blocks on disk.

#[cfg(feature = "checkpoint")]
use super::sealed;
use crate::{Error, Result, rock::Snapshot};
use std::path::Path;

/// The state of blocks between two steps of a scene without fluid.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockCheckpoint {
    /// Steps done.
    pub step: u64,
    /// Length of a step, s.
    pub time_step: f64,
    /// The blocks.
    pub snapshot: Snapshot,
}

/// First bytes of a file; the digit is the version of the format.
#[cfg(feature = "checkpoint")]
const MAGIC: &sealed::Magic = b"riprap rocks  2\n";
/// Step, time step.
const HEADER: usize = 8 + 8;

#[cfg(feature = "checkpoint")]
impl BlockCheckpoint {
    /// Writes the file; one that is there stays whole until the new one is complete.
    ///
    /// # Errors
    /// [`Error::File`] if it cannot be written.
    pub fn write(&self, path: &Path) -> Result<()> {
        sealed::write(path, MAGIC, |file| {
            file.write_all(&self.step.to_le_bytes())?;
            file.write_all(&self.time_step.to_le_bytes())?;
            file.write_all(&self.snapshot.to_bytes())
        })
    }

    /// Reads a file.
    ///
    /// # Errors
    /// [`Error::File`] if it cannot be read, is no checkpoint of blocks, or is not as it was written.
    pub fn read(path: &Path) -> Result<Self> {
        let bytes = sealed::read(path, MAGIC, "blocks alone")?;
        let Some((header, rest)) = bytes.split_at_checked(HEADER) else {
            let message = "the checkpoint is cut short; use an older one";
            return Err(Error::file(path, message));
        };
        let word = |at: usize| u64::from_le_bytes(std::array::from_fn(|k| header[at + k]));
        let snapshot = Snapshot::from_bytes(rest).map_err(|error| match error {
            Error::Argument { message, .. } => Error::file(path, message),
            other => other,
        })?;
        Ok(Self {
            step: word(0),
            time_step: f64::from_bits(word(8)),
            snapshot,
        })
    }
}

#[cfg(all(test, feature = "checkpoint"))]
mod tests {
    use super::*;

    /// What an older version wrote stays refused however old the file; what is cut short has older ones that are not.
    #[test]
    fn only_a_file_that_is_cut_short_sends_to_an_older_one() {
        let name = format!("riprap_blocks_{}.checkpoint", std::process::id());
        let path = std::env::temp_dir().join(name);
        let checkpoint = BlockCheckpoint {
            step: 1,
            time_step: 0.1,
            snapshot: Snapshot::default(),
        };
        checkpoint.write(&path).expect("a folder to write to");
        let whole = std::fs::read(&path).expect("the file");
        let refusal = |bytes: &[u8]| {
            std::fs::write(&path, bytes).expect("a folder to write to");
            let error = BlockCheckpoint::read(&path).expect_err("it is spoilt");
            error.to_string()
        };
        let mut before = whole.clone();
        // The version.
        before[14] = b'1';
        let version = refusal(&before);
        let cut = refusal(&whole[..whole.len() - 1]);
        std::fs::remove_file(&path).expect("the file");
        assert!(
            version.contains("version 1") && !version.contains("older"),
            "{version}"
        );
        assert_eq!(cut.matches("use an older").count(), 1, "{cut}");
    }
}
