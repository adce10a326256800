//! How fluid and blocks met in a run, in numbers.

use riprap::{coupling::Exchanges, simulation::Simulation};
use serde::Serialize;
use std::fmt;

/// What the coupling of a run did, and what it could leave out.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Coupling {
    /// Blocks in the fluid; the others are its solids.
    pub in_fluid: usize,
    /// Convex parts of blocks in lanes of bricks at the end.
    pub tiles: usize,
    /// Bricks of the lattice that blocks reach at the end.
    pub saturated_bricks: usize,
    /// Bricks without walls that no block reaches.
    pub plain_bricks: usize,
    /// Bricks with walls or solids that no block reaches.
    pub mixed_bricks: usize,
    /// Tiles whose solid fractions were computed, all steps together.
    pub tiles_computed: u64,
    /// Lanes of bricks whose saturation was computed, all steps together.
    pub lanes_computed: u64,
    /// Times that the tiles of blocks were looked for.
    pub searches: u64,
    /// Loads of a step that were read back.
    pub readings: u64,
    /// Steps of this run whose loads nobody needed.
    pub readings_skipped: u64,
    /// Bytes that blocks take on the device, without the saturation of their bricks.
    pub bytes: u64,
}

impl Coupling {
    /// Of the blocks in `simulation`, if there are any, after `steps` of this run.
    pub fn of(simulation: &Simulation, steps: u64) -> Option<Self> {
        let coupled = simulation.coupled()?;
        let cells = coupled.solid_cells();
        let geometry = simulation.lattice()?.geometry();
        let solid_bricks = cells.bricks();
        let others = |list: &[u32]| {
            let reached = |brick: &&u32| solid_bricks.binary_search(brick).is_err();
            list.iter().filter(reached).count()
        };
        let Exchanges {
            readings,
            cells: work,
        } = coupled.exchanges();
        Some(Self {
            in_fluid: coupled.in_fluid(),
            tiles: cells.tiles(),
            saturated_bricks: solid_bricks.len(),
            plain_bricks: others(&geometry.plain),
            mixed_bricks: others(&geometry.mixed),
            tiles_computed: work.tiles,
            lanes_computed: work.lanes,
            searches: work.searches,
            readings,
            readings_skipped: steps.saturating_sub(readings),
            bytes: cells.bytes(),
        })
    }

    /// How many bricks of which kind there are, in words.
    pub fn kinds(&self) -> String {
        format!(
            "{} tiles in {} bricks with blocks, {} mixed and {} plain ones without",
            self.tiles, self.saturated_bricks, self.mixed_bricks, self.plain_bricks
        )
    }
}

impl fmt::Display for Coupling {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let steps = (self.readings + self.readings_skipped).max(1) as f64;
        write!(
            f,
            "  {} blocks in the fluid: {}; a step computed {:.1} tiles and {:.1} lanes of bricks anew, in {} \
             searches; {} loads read back, {} steps without",
            self.in_fluid,
            self.kinds(),
            self.tiles_computed as f64 / steps,
            self.lanes_computed as f64 / steps,
            self.searches,
            self.readings,
            self.readings_skipped
        )
    }
}
