//! Which tiles there are, and which of them are to be computed again.

use super::{Tile, tiles::Outline, tiles::Tiling};
use crate::{
    geometry::Pose,
    lattice::{Geometry, Grid},
};
use std::ops::Range;

/// Distance that a point of a block may go before its tiles are looked for anew, cells. Tiles reach as far
/// beyond the block, so that a larger one costs tiles that hold nothing, a smaller one searches.
pub const SKIN: f64 = 1.0;
/// A block changes how its direct neighbours relax: a cell beyond the block.
const NEIGHBOURS: f64 = 1.0;

/// Tiles by block, brick and part.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// Of each block.
    found: Vec<Found>,
    /// All of them, by block.
    pub tiles: Vec<Tile>,
    /// Bricks with blocks.
    pub bricks: Vec<u32>,
    /// Tiles of each block.
    pub block_first: Vec<u32>,
    /// Tiles of each lane of a brick with blocks, slot · lanes + lane: where they begin in `lane_tiles`.
    pub lane_first: Vec<u32>,
    /// Tiles by lane.
    pub lane_tiles: Vec<u32>,
    /// Lanes of a brick.
    lanes: u32,
}

/// The tiles of a block.
#[derive(Clone, Debug, Default)]
struct Found {
    /// Pose for which they were found.
    pose: Option<Pose>,
    /// The tiles, each with its brick.
    tiles: Vec<(u32, Tile)>,
}

impl Plan {
    /// For some blocks.
    pub fn new(blocks: usize) -> Self {
        Self {
            found: vec![Found::default(); blocks],
            ..Self::default()
        }
    }

    /// Whether a block that was found at another pose may have left its tiles.
    pub fn has_strayed(&self, block: usize, pose: &Pose, radius: f64, cell: f64) -> bool {
        self.stray(block, pose, radius, cell) > SKIN
    }

    /// How far a point of the block may have gone since its tiles were found, cells.
    fn stray(&self, block: usize, pose: &Pose, radius: f64, cell: f64) -> f64 {
        let Some(then) = &self.found[block].pose else {
            return f64::INFINITY;
        };
        let change = pose.deformation - then.deformation;
        let columns = [change.x_axis, change.y_axis, change.z_axis];
        let square: f64 = columns.iter().map(|c| c.length_squared()).sum();
        ((pose.centre - then.centre).length() + square.sqrt() * radius) / cell
    }

    /// Where the tiles of a block were found.
    pub fn found_at(&self, block: usize) -> Option<Pose> {
        self.found[block].pose
    }

    /// Forgets the tiles of a block.
    pub fn forget(&mut self, block: usize) {
        self.found[block] = Found::default();
    }

    /// Finds the tiles of a block anew if it has gone far enough for that to be due soon.
    pub fn find(
        &mut self,
        tiling: &Tiling,
        block: usize,
        (pose, radius, cell): (&Pose, f64, f64),
        outlines: &[Outline],
        first_part: u32,
    ) {
        if self.stray(block, pose, radius, cell) < 0.5 * SKIN {
            return;
        }
        let mut tiles = tiling.tiles_of_block(outlines, NEIGHBOURS + SKIN);
        for (_, tile) in &mut tiles {
            tile.part += first_part;
            tile.block = block as u32;
        }
        self.found[block] = Found {
            pose: Some(*pose),
            tiles,
        };
    }

    /// Puts the tiles of all blocks together; those in bricks without fluid are left out.
    pub fn assemble(&mut self, geometry: &Geometry, grid: &Grid) {
        const NONE: u32 = u32::MAX;
        let lanes = grid.lanes;
        let mut slot_of = vec![NONE; grid.bricks().iter().product::<u32>() as usize];
        let all = self.found.iter().flat_map(|found| &found.tiles);
        self.bricks.clear();
        for (brick, _) in all {
            let slot = &mut slot_of[*brick as usize];
            if *slot == NONE && geometry.runs(*brick) {
                *slot = 0;
                self.bricks.push(*brick);
            }
        }
        self.bricks.sort_unstable();
        for (slot, brick) in (0..).zip(&self.bricks) {
            slot_of[*brick as usize] = slot;
        }
        self.tiles.clear();
        self.block_first.clear();
        let rows = self.bricks.len() * lanes as usize;
        self.lane_first.clear();
        self.lane_first.resize(rows + 1, 0);
        self.lanes = lanes;
        for found in &self.found {
            self.block_first.push(self.tiles.len() as u32);
            for (brick, tile) in &found.tiles {
                let slot = slot_of[*brick as usize];
                if slot != NONE {
                    let tile = Tile { slot, ..*tile };
                    self.lane_first[(slot * lanes + tile.lane) as usize + 1] += 1;
                    self.tiles.push(tile);
                }
            }
        }
        self.block_first.push(self.tiles.len() as u32);
        for row in 0..rows {
            self.lane_first[row + 1] += self.lane_first[row];
        }
        let mut next = self.lane_first.clone();
        self.lane_tiles.clear();
        self.lane_tiles.resize(self.tiles.len(), 0);
        for (number, tile) in (0..).zip(&self.tiles) {
            let at = &mut next[(tile.slot * lanes + tile.lane) as usize];
            self.lane_tiles[*at as usize] = number;
            *at += 1;
        }
    }

    /// Tiles of a block.
    pub fn tiles_of(&self, block: usize) -> Range<u32> {
        self.block_first[block]..self.block_first[block + 1]
    }

    /// Lanes of bricks in which the blocks have tiles, ascending.
    pub fn lanes_of(&self, blocks: impl Iterator<Item = usize>) -> Vec<u32> {
        let mut taken = vec![false; self.lane_count()];
        for block in blocks {
            for tile in &self.tiles[range(self.tiles_of(block))] {
                taken[(tile.slot * self.lanes + tile.lane) as usize] = true;
            }
        }
        (0..)
            .zip(taken)
            .filter_map(|(lane, taken)| taken.then_some(lane))
            .collect()
    }

    /// Lanes of all bricks with blocks.
    pub fn lane_count(&self) -> usize {
        self.bricks.len() * self.lanes as usize
    }
}

fn range(tiles: Range<u32>) -> Range<usize> {
    tiles.start as usize..tiles.end as usize
}
