//! The blocks in a fluid between two steps, whole.

use super::{Coupled, Felt, Follower};
use crate::{
    Error, Result,
    bodies::{Load, Snapshot},
};
use glam::{DMat3, DVec3};

/// Numbers of a load.
const LOAD: usize = 20;
/// Numbers of a block: how its water follows, its last load, and what it feels.
const BLOCK: usize = 13 + 3 * LOAD;

/// Everything that the next steps of blocks in a fluid depend on beside the fluid.
#[derive(Clone, Debug, PartialEq)]
pub struct CoupledState {
    /// The blocks.
    snapshot: Snapshot,
    /// Whether loads have been read.
    begun: bool,
    blocks: Vec<(Follower, Load, Felt)>,
}

impl CoupledState {
    /// As bytes, the same on every machine.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        bytes.extend(u64::from(self.begun).to_le_bytes());
        bytes.extend((self.blocks.len() as u64).to_le_bytes());
        for (follower, last, felt) in &self.blocks {
            let loads = [last, &felt.flow, &felt.buoyancy];
            let numbers = follower
                .to_numbers()
                .into_iter()
                .chain(loads.into_iter().flat_map(numbers));
            bytes.extend(numbers.flat_map(f64::to_le_bytes));
        }
        bytes.extend(self.snapshot.to_bytes());
        bytes
    }

    /// From what [`CoupledState::to_bytes`] gave.
    ///
    /// # Errors
    /// [`Error::Scene`] if the bytes are none, or are cut short.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let cut = || Error::scene("blocks", "the state of the blocks is cut short");
        let word = |at: usize| -> Result<[u8; 8]> {
            let part = bytes.get(at..at + 8).and_then(|part| part.try_into().ok());
            part.ok_or_else(cut)
        };
        let begun = u64::from_le_bytes(word(0)?) != 0;
        let count = u64::from_le_bytes(word(8)?) as usize;
        let end = count
            .checked_mul(8 * BLOCK)
            .and_then(|size| size.checked_add(16))
            .ok_or_else(cut)?;
        let rows = bytes.get(16..end).ok_or_else(cut)?;
        let blocks = rows.chunks_exact(8 * BLOCK).map(|row| {
            let mut values = row
                .chunks_exact(8)
                .map(|word| f64::from_le_bytes(std::array::from_fn(|k| word[k])));
            let follower = std::array::from_fn(|_| values.next().unwrap_or_default());
            let mut load =
                || from_numbers(std::array::from_fn(|_| values.next().unwrap_or_default()));
            let last = load();
            let felt = Felt {
                flow: load(),
                buoyancy: load(),
            };
            (Follower::from_numbers(&follower), last, felt)
        });
        Ok(Self {
            begun,
            blocks: blocks.collect(),
            snapshot: Snapshot::from_bytes(&bytes[end..])?,
        })
    }
}

impl Coupled {
    /// The present state, for a later [`Coupled::restore`].
    pub fn state(&self) -> CoupledState {
        let blocks = self.felt.iter().enumerate().map(|(block, felt)| {
            let last = self.last.get(block).copied().unwrap_or_default();
            (self.followers[block], last, *felt)
        });
        CoupledState {
            snapshot: self.blocks.snapshot(),
            begun: self.begun,
            blocks: blocks.collect(),
        }
    }

    /// Goes back, or on, to a state of the same blocks: the next steps give the same bits.
    ///
    /// # Errors
    /// [`Error::Scene`] if it is of other blocks.
    pub fn restore(&mut self, state: &CoupledState) -> Result<()> {
        if state.blocks.len() != self.blocks.len() {
            let message = format!(
                "it holds {} blocks, these are {} of another scene",
                state.blocks.len(),
                self.blocks.len()
            );
            return Err(Error::scene("restart", message));
        }
        self.blocks
            .restore(&state.snapshot)
            .map_err(|error| Error::scene("restart", error.to_string()))?;
        self.begun = state.begun;
        for (block, (follower, last, felt)) in state.blocks.iter().enumerate() {
            self.followers[block] = *follower;
            self.felt[block] = *felt;
            if let Some(kept) = self.last.get_mut(block) {
                *kept = *last;
            }
        }
        self.placed = false;
        Ok(())
    }
}

fn numbers(load: &Load) -> [f64; LOAD] {
    let mut all = [0.0; LOAD];
    all[..3].copy_from_slice(&load.force.to_array());
    all[3..12].copy_from_slice(&load.moment.to_cols_array());
    all[12] = load.entrained;
    all[13] = load.missing;
    all[14..17].copy_from_slice(&load.entrained_moment.to_array());
    all[17..].copy_from_slice(&load.missing_moment.to_array());
    all
}

fn from_numbers(all: [f64; LOAD]) -> Load {
    let vector = |n: usize| DVec3::new(all[n], all[n + 1], all[n + 2]);
    Load {
        force: vector(0),
        moment: DMat3::from_cols(vector(3), vector(6), vector(9)),
        entrained: all[12],
        missing: all[13],
        entrained_moment: vector(14),
        missing_moment: vector(17),
    }
}
