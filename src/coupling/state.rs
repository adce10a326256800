//! The state of coupled blocks between two steps.

use super::{Coupled, FluidLoad, InteriorInertia, LoadAverage};
use crate::{
    Error, Result,
    geometry::{Load, Pose},
    rock::Snapshot,
};
use glam::{DMat3, DVec3};

/// Numbers of a load.
const LOAD: usize = 20;
/// Numbers of an optional pose without velocities: a flag, position and deformation.
const POSE: usize = 13;
/// Numbers of a block: its interior inertia, four loads, a pose.
const BLOCK: usize = 13 + 4 * LOAD + POSE;
/// Bytes of the header: the last step that was read, the steps since the last exchange, the number of blocks.
const HEADER: usize = 24;

/// The state of blocks in a fluid, without the fluid: everything on which their next steps depend.
#[derive(Clone, Debug, PartialEq)]
pub struct CoupledState {
    /// The blocks.
    snapshot: Snapshot,
    /// Step of the last loads that were read; 0 if there are none.
    last: u64,
    /// Steps read since the last exchange.
    steps: u64,
    blocks: Vec<BlockState>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct BlockState {
    interior: InteriorInertia,
    /// Load of the last step that was read.
    last: Load,
    /// Sum of the loads since the last exchange.
    sum: Load,
    cell_load: FluidLoad,
    /// Pose of its last tile search: the tiles determine the order of summation, and so the rounding of loads.
    tiled: Option<Pose>,
}

impl CoupledState {
    /// The state as bytes, independent of the machine.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        for word in [self.last, self.steps, self.blocks.len() as u64] {
            bytes.extend(word.to_le_bytes());
        }
        for block in &self.blocks {
            bytes.extend(block.to_numbers().into_iter().flat_map(f64::to_le_bytes));
        }
        bytes.extend(self.snapshot.to_bytes());
        bytes
    }

    /// The inverse of [`CoupledState::to_bytes`].
    ///
    /// # Errors
    /// [`Error::Scene`] if the bytes are invalid or truncated.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let cut = || {
            Error::argument(
                "blocks",
                "the state of the blocks is truncated; use a complete checkpoint",
            )
        };
        let word = |at: usize| -> Result<u64> {
            let part = bytes.get(at..at + 8).and_then(|part| part.try_into().ok());
            part.map(u64::from_le_bytes).ok_or_else(cut)
        };
        let count = usize::try_from(word(16)?).map_err(|_| cut())?;
        let end = count
            .checked_mul(8 * BLOCK)
            .and_then(|size| size.checked_add(HEADER))
            .ok_or_else(cut)?;
        let rows = bytes.get(HEADER..end).ok_or_else(cut)?;
        let number = |word: &[u8]| f64::from_le_bytes(std::array::from_fn(|k| word[k]));
        let blocks = rows.chunks_exact(8 * BLOCK).map(|row| {
            let mut numbers = row.chunks_exact(8).map(number);
            BlockState::from_numbers(std::array::from_fn(|_| numbers.next().unwrap_or_default()))
        });
        Ok(Self {
            last: word(0)?,
            steps: word(8)?,
            blocks: blocks.collect(),
            snapshot: Snapshot::from_bytes(&bytes[end..])?,
        })
    }
}

impl BlockState {
    fn to_numbers(self) -> [f64; BLOCK] {
        let Self {
            interior,
            last,
            sum,
            cell_load,
            tiled,
        } = self;
        let mut all = [0.0; BLOCK];
        let (head, rest) = all.split_at_mut(13);
        head.copy_from_slice(&interior.to_numbers());
        let (loads, pose) = rest.split_at_mut(4 * LOAD);
        let each = [last, sum, cell_load.flow, cell_load.buoyancy];
        for (place, load) in loads.chunks_exact_mut(LOAD).zip(each) {
            place.copy_from_slice(&load_numbers(&load));
        }
        if let Some(tiled) = tiled {
            pose[0] = 1.0;
            pose[1..4].copy_from_slice(&tiled.centre.to_array());
            pose[4..].copy_from_slice(&tiled.deformation.to_cols_array());
        }
        all
    }

    fn from_numbers(all: [f64; BLOCK]) -> Self {
        let load = |n: usize| load_from(&all[13 + n * LOAD..][..LOAD]);
        let pose = &all[13 + 4 * LOAD..];
        Self {
            interior: InteriorInertia::from_numbers(&std::array::from_fn(|k| all[k])),
            last: load(0),
            sum: load(1),
            cell_load: FluidLoad {
                flow: load(2),
                buoyancy: load(3),
            },
            tiled: (pose[0] != 0.0).then(|| Pose {
                centre: DVec3::from_slice(&pose[1..4]),
                deformation: DMat3::from_cols_slice(&pose[4..]),
                velocity: DVec3::ZERO,
                deformation_rate: DMat3::ZERO,
            }),
        }
    }
}

impl Coupled {
    /// The present state, for a later [`Coupled::restore`]; waits for the loads in flight.
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn state(&mut self) -> Result<CoupledState> {
        let (rock, coupling) = self.rock_and_coupling();
        coupling.read_loads().await?;
        let LoadAverage { last, sum, steps } = &coupling.load_average;
        let last_loads = last.as_ref().map_or(&[][..], |(_, loads)| loads);
        let of = |loads: &[Load], block: usize| loads.get(block).copied().unwrap_or_default();
        let tiled = coupling.cells.tiled();
        let block = |block: usize| BlockState {
            interior: rock.interior[block],
            last: of(last_loads, block),
            sum: of(sum, block),
            cell_load: rock.cell_load[block],
            tiled: tiled.get(block).copied().flatten(),
        };
        Ok(CoupledState {
            snapshot: rock.blocks.snapshot(),
            last: last.as_ref().map_or(0, |(step, _)| *step),
            steps: *steps,
            blocks: (0..rock.blocks.len()).map(block).collect(),
        })
    }

    /// Restores a state of the same blocks: the next steps yield the same bits.
    ///
    /// # Errors
    /// [`Error::Scene`] if it is of other blocks.
    pub fn restore(&mut self, state: &CoupledState) -> Result<()> {
        let in_fluid = self.in_fluid();
        let (rock, coupling) = self.rock_and_coupling();
        if state.blocks.len() != rock.blocks.len() {
            let message = format!(
                "the state holds {} blocks, but the scene has {}; use a checkpoint of this scene",
                state.blocks.len(),
                rock.blocks.len()
            );
            return Err(Error::argument("restart", message));
        }
        rock.restore(&state.snapshot)?;
        coupling.load_readback.discard();
        coupling.face_readback.discard();
        coupling.face_loads.clear();
        let blocks = &state.blocks[..in_fluid];
        let last = || blocks.iter().map(|block| block.last).collect();
        coupling.load_average = LoadAverage {
            last: (state.last > 0).then(|| (state.last, last())),
            sum: blocks.iter().map(|block| block.sum).collect(),
            steps: state.steps,
        };
        rock.interior = state.blocks.iter().map(|block| block.interior).collect();
        rock.cell_load = state.blocks.iter().map(|block| block.cell_load).collect();
        rock.update_external_load();
        let tiled: Vec<_> = blocks.iter().map(|block| block.tiled).collect();
        coupling.cells.tile(&tiled);
        coupling.placed = None;
        Ok(())
    }
}

fn load_numbers(load: &Load) -> [f64; LOAD] {
    let mut all = [0.0; LOAD];
    all[..3].copy_from_slice(&load.force.to_array());
    all[3..12].copy_from_slice(&load.moment.to_cols_array());
    all[12] = load.entrained;
    all[13] = load.missing;
    all[14..17].copy_from_slice(&load.entrained_moment.to_array());
    all[17..].copy_from_slice(&load.missing_moment.to_array());
    all
}

fn load_from(all: &[f64]) -> Load {
    Load {
        force: DVec3::from_slice(&all[..3]),
        moment: DMat3::from_cols_slice(&all[3..12]),
        entrained: all[12],
        missing: all[13],
        entrained_moment: DVec3::from_slice(&all[14..17]),
        missing_moment: DVec3::from_slice(&all[17..]),
    }
}
