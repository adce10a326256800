//! A state on disk: canonical order, so that it restarts under any storage, lanes or bindings.

mod blocks;
#[cfg(feature = "checkpoint")]
mod sealed;
mod water;

pub use blocks::BlockCheckpoint;
pub use water::WaterCheckpoint;

use crate::{
    Error, Result,
    coupling::CoupledState,
    lattice::{Inside, Populations},
};
use std::path::Path;

/// The state of a simulation between two steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// Time step, s.
    pub time_step: f64,
    /// Cell size, m.
    pub cell: f64,
    /// The fluid.
    pub populations: Populations,
    /// Velocities where blocks are, which nothing of the next step depends on.
    pub inside: Inside,
    /// The blocks in it.
    pub blocks: Option<CoupledState>,
}

/// First bytes of a file; the digit is the version of the format.
#[cfg(feature = "checkpoint")]
const MAGIC: &sealed::Magic = b"riprap state  4\n";
/// Step, three cell counts, four lengths, time step, cell, bytes of the blocks.
const HEADER: usize = 8 + 3 * 4 + 4 * 8 + 2 * 8 + 8;

#[cfg(feature = "checkpoint")]
impl Checkpoint {
    /// Writes the file; one that is there stays whole until the new one is complete.
    ///
    /// # Errors
    /// [`Error::File`] if it cannot be written.
    pub fn write(&self, path: &Path) -> Result<()> {
        let Populations {
            step,
            cells,
            values,
            velocity,
            carried,
        } = &self.populations;
        sealed::write(path, MAGIC, |file| {
            file.write_all(&step.to_le_bytes())?;
            for n in cells {
                file.write_all(&n.to_le_bytes())?;
            }
            let lists = [values, velocity, carried, &self.inside.velocity];
            for list in lists {
                file.write_all(&(list.len() as u64).to_le_bytes())?;
            }
            file.write_all(&self.time_step.to_le_bytes())?;
            file.write_all(&self.cell.to_le_bytes())?;
            let blocks = self.blocks.as_ref().map(CoupledState::to_bytes);
            let blocks = blocks.unwrap_or_default();
            file.write_all(&(blocks.len() as u64).to_le_bytes())?;
            for list in lists {
                let mut bytes = Vec::with_capacity(4 * list.len());
                bytes.extend(list.iter().flat_map(|value| value.to_le_bytes()));
                file.write_all(&bytes)?;
            }
            for cell in &self.inside.cells {
                file.write_all(&cell.to_le_bytes())?;
            }
            file.write_all(&blocks)
        })
    }

    /// Reads a file.
    ///
    /// # Errors
    /// [`Error::File`] if it cannot be read, is no checkpoint, or is not as it was written.
    pub fn read(path: &Path) -> Result<Self> {
        let bytes = sealed::read(path, MAGIC, "a fluid on a lattice")?;
        let broken = |message: &str| Error::file(path, message);
        let long = |at: usize| {
            let part = bytes.get(at..at + 8).and_then(|part| part.try_into().ok());
            part.map(u64::from_le_bytes).ok_or_else(|| broken(CUT))
        };
        let short = |at: usize| {
            let part = bytes.get(at..at + 4).and_then(|part| part.try_into().ok());
            part.map(u32::from_le_bytes).ok_or_else(|| broken(CUT))
        };
        let cells = [short(8)?, short(12)?, short(16)?];
        let lengths = [long(20)?, long(28)?, long(36)?, long(44)?];
        let inside = lengths[3] / 3;
        let expected = lengths
            .iter()
            .chain([&inside])
            .fold(0u64, |sum, n| sum.saturating_add(n.saturating_mul(4)));
        let rest = bytes.len().saturating_sub(HEADER) as u64;
        if expected.saturating_add(long(68)?) != rest {
            return Err(broken(CUT));
        }
        let (values, blocks) = bytes[HEADER..].split_at(expected as usize);
        let blocks = match blocks {
            [] => None,
            _ => Some(
                CoupledState::from_bytes(blocks).map_err(|error| match error {
                    Error::Argument { message, .. } => broken(&message),
                    other => other,
                })?,
            ),
        };
        let words = values.chunks_exact(4);
        let mut words = words.map(|part| u32::from_le_bytes(std::array::from_fn(|k| part[k])));
        let mut list = |n: u64| {
            words
                .by_ref()
                .take(n as usize)
                .map(f32::from_bits)
                .collect()
        };
        let [values, velocity, carried, shown] = lengths.map(&mut list);
        let inside = Inside {
            cells: words.collect(),
            velocity: shown,
        };
        Ok(Self {
            inside,
            time_step: f64::from_bits(long(52)?),
            cell: f64::from_bits(long(60)?),
            blocks,
            populations: Populations {
                step: long(0)?,
                cells,
                values,
                velocity,
                carried,
            },
        })
    }
}

const CUT: &str = "the checkpoint is cut short; use an older one";
