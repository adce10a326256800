//! Files of state with a checksum at their end: what a disk or a copy has damaged is not gone on from.

use crate::{
    Error, Result,
    output::{failure, replace},
};
use crc32fast::Hasher;
use std::{
    io::{self, Write},
    path::Path,
};

/// First bytes of a file: the form, and in [`VERSION`] its version, a digit.
pub(super) type Magic = [u8; 16];
/// Where the version is.
const VERSION: usize = 14;
/// Bytes of the checksum.
const SUM: usize = 4;

/// Writes `magic`, the content and their CRC-32 (IEEE 802.3); a file that is there stays whole until the new one is
/// complete.
///
/// # Errors
/// [`Error::File`] if it cannot be written.
pub(super) fn write(
    path: &Path,
    magic: &Magic,
    content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<()> {
    replace(path, |file| {
        let mut summed = Summed {
            file,
            sum: Hasher::new(),
        };
        summed.write_all(magic)?;
        content(&mut summed)?;
        let sum = summed.sum.finalize();
        summed.file.write_all(&sum.to_le_bytes())
    })
}

/// What follows `magic` in a file, up to the checksum; `what` is in it.
///
/// # Errors
/// [`Error::File`] if it cannot be read, is no such file, or is not as it was written.
pub(super) fn read(path: &Path, magic: &Magic, what: &str) -> Result<Vec<u8>> {
    let mut bytes = std::fs::read(path).map_err(|error| failure("read", path, &error))?;
    let broken = |message: String| Err(Error::file(path, message));
    let form = |bytes: &[u8]| bytes.get(..VERSION).map(<[u8]>::to_vec);
    if form(&bytes) != form(magic) {
        return broken(format!(
            "this is not a checkpoint of {what}; give the checkpoint.riprap that a run of such a scene wrote"
        ));
    }
    if bytes
        .get(VERSION)
        .is_some_and(|digit| *digit != magic[VERSION])
    {
        let version = |bytes: &[u8]| bytes.get(VERSION).map_or('?', |&digit| char::from(digit));
        return broken(format!(
            "this checkpoint has version {} of its format, and this riprap reads version {}; go on with the riprap \
             that wrote it, or run the scene from its start",
            version(&bytes),
            version(magic)
        ));
    }
    let damaged = "the checkpoint is cut short or damaged: its checksum is not that of its bytes; use an older one, or \
                   run the scene from its start";
    let end = bytes.len() - SUM.min(bytes.len());
    let (content, sum) = bytes.split_at(end);
    if end < magic.len() || sum != crc32fast::hash(content).to_le_bytes() {
        return broken(damaged.into());
    }
    bytes.truncate(end);
    Ok(bytes.split_off(magic.len()))
}

/// Sums what passes.
struct Summed<'a> {
    file: &'a mut dyn Write,
    sum: Hasher,
}

impl Write for Summed<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.file.write(bytes)?;
        self.sum.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}
