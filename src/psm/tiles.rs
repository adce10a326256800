//! Tiles: the bricks that convex parts reach, and their update when blocks move.

use super::Tile;
use crate::{
    geometry::Pose,
    lattice::{Geometry, Grid},
};
use glam::DVec3;
use std::ops::Range;

/// A convex part at its position, cells.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outline {
    /// Centroid, from the lower corner of the domain.
    pub centre: DVec3,
    /// Corners of its bounding box, from the centroid; for a sphere in a fluid, of its effective radius.
    pub low: DVec3,
    /// See `low`.
    pub high: DVec3,
    /// Outward unit normals and distances from the centroid; empty for a sphere.
    pub faces: Vec<(DVec3, f64)>,
    /// Radius of a sphere.
    pub radius: f64,
}

impl Outline {
    /// The outline with the box of the effective radius of a sphere, which is larger by `growth` (cells²) over the radius.
    pub fn grown(mut self, growth: f64) -> Self {
        if self.faces.is_empty() {
            let effective = self.radius + growth / self.radius.max(LEAST_RADIUS);
            (self.low, self.high) = (DVec3::splat(-effective), DVec3::splat(effective));
        }
        self
    }

    /// Whether a box of half extents `half` around `middle` (from the centroid) certainly does not touch the part.
    fn is_off(&self, middle: DVec3, half: DVec3) -> bool {
        if (middle + half).cmplt(self.low).any() || (middle - half).cmpgt(self.high).any() {
            return true;
        }
        if self.faces.is_empty() {
            let gap = (middle.abs() - half).max(DVec3::ZERO);
            return gap.length_squared() > self.high.x * self.high.x;
        }
        let faces = self.faces.iter();
        faces
            .map(|(normal, distance)| normal.dot(middle) - distance - normal.abs().dot(half))
            .any(|gap| gap > 0.0)
    }
}

/// Radius below which the growth of spheres is constant, cells: `LEAST_RADIUS` of the kernel.
const LEAST_RADIUS: f64 = 2.0;

/// The bricks along an axis that an interval reaches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Span {
    brick: u32,
    lane: u32,
    /// Lowest cell, shifted by whole periods.
    cell: i32,
    /// Number of its cells in the domain.
    inside: u32,
}

/// The tiling of a grid.
#[derive(Clone, Copy, Debug)]
pub struct Tiling {
    grid: Grid,
    periodic: [bool; 3],
    /// The eighths of a tile that lies completely in the domain.
    eighths: Eighths,
}

/// Bounding boxes of the eighths of a tile, in cells from its lowest corner: middle and half extents. Rows and layers that an
/// eighth contains in part count as complete. `None` without a cell in the domain.
type Eighths = [Option<[DVec3; 2]>; Tile::EIGHTHS as usize];

/// The eighths of a tile with `inside` cells in the domain.
fn eighths(brick: [u32; 3], inside: [u32; 3]) -> Eighths {
    let cells: u32 = brick.iter().product();
    let size = cells.div_ceil(Tile::EIGHTHS);
    let place = |k: u32| {
        [
            k % brick[0],
            k / brick[0] % brick[1],
            k / (brick[0] * brick[1]),
        ]
    };
    std::array::from_fn(|eighth| {
        let [first, last] = [eighth as u32, eighth as u32 + 1].map(|end| (end * size).min(cells));
        if first == last {
            return None;
        }
        let [first, last] = [place(first), place(last - 1)];
        let whole = [first[1..] != last[1..], first[2] != last[2], false];
        let side = |axis: usize| match whole[axis] {
            true => [0, inside[axis]],
            false => [first[axis], (last[axis] + 1).min(inside[axis])],
        };
        let sides = [0, 1, 2].map(side);
        let [low, high] = [0, 1].map(|end| DVec3::from_array(sides.map(|side| side[end].into())));
        let half = 0.5 * (high - low);
        (half.min_element() > 0.0).then_some([low + half, half])
    })
}

impl Tiling {
    /// Of a grid with periodic axes.
    pub fn new(grid: Grid, periodic: [bool; 3]) -> Self {
        Self {
            grid,
            periodic,
            eighths: eighths(grid.brick, grid.brick),
        }
    }

    /// Cells of the domain, and which of its axes are periodic.
    pub fn domain(&self) -> ([u32; 3], [bool; 3]) {
        (self.grid.cells, self.periodic)
    }

    /// The tiles of the parts of a block with its images along axes that are `imaged`, with parts numbered from 0 and
    /// grown by `margin` cells, without slots, each with its brick; in the order of parts, bricks and lanes.
    pub fn tiles_of_block(
        &self,
        outlines: &[Outline],
        margin: f64,
        imaged: [bool; 3],
    ) -> Vec<(u32, Tile)> {
        let parts = (0..).zip(outlines);
        let tiles = parts.flat_map(|(part, outline)| {
            let tiles = self.tiles(outline, margin, imaged).into_iter();
            tiles.map(move |(brick, tile)| (brick, Tile { part, ..tile }))
        });
        tiles.collect()
    }

    /// The tiles of a part, with its images along axes that are `imaged`.
    fn tiles(&self, outline: &Outline, margin: f64, imaged: [bool; 3]) -> Vec<(u32, Tile)> {
        let [x, y, z] = [0, 1, 2].map(|axis| {
            let low = outline.centre[axis] + outline.low[axis] - margin;
            let high = outline.centre[axis] + outline.high[axis] + margin;
            self.spans(axis, [low, high], imaged[axis])
        });
        let [bx, by, _] = self.grid.bricks();
        let mut tiles = Vec::new();
        for z in &z {
            for y in &y {
                for x in &x {
                    let cell = [x.cell, y.cell, z.cell];
                    let inside = [x.inside, y.inside, z.inside];
                    let Some(reach) = self.reach(outline, margin, (cell, inside)) else {
                        continue;
                    };
                    let tile = Tile {
                        cell,
                        lane: y.lane + z.lane,
                        inside: Tile::pack(inside),
                        ..Tile::default()
                    };
                    let brick = x.brick + bx * (y.brick + by * z.brick);
                    tiles.push((brick, tile.reaching(reach)));
                }
            }
        }
        tiles.sort_by_key(|(brick, tile)| (*brick, tile.lane, tile.cell));
        tiles
    }

    /// The eighths that a part grown by `margin` cells reaches of the tile at `cell` with `inside` cells in the domain: the
    /// first, and one past the last.
    fn reach(
        &self,
        outline: &Outline,
        margin: f64,
        (cell, inside): ([i32; 3], [u32; 3]),
    ) -> Option<[u32; 2]> {
        let corner = DVec3::from_array(cell.map(f64::from)) - outline.centre;
        let margin = DVec3::splat(margin);
        let reaches = |of: &Option<[DVec3; 2]>| {
            of.is_some_and(|[middle, half]| !outline.is_off(corner + middle, half + margin))
        };
        let eighths = match inside == self.grid.brick {
            true => self.eighths,
            false => eighths(self.grid.brick, inside),
        };
        let first = eighths.iter().position(reaches)?;
        let last = eighths.iter().rposition(reaches)?;
        Some([first as u32, last as u32 + 1])
    }

    /// Ranges of bricks between `low` and `high` on an axis, including periodic images if `imaged`.
    fn spans(&self, axis: usize, [low, high]: [f64; 2], imaged: bool) -> Vec<Span> {
        let cells = i64::from(self.grid.cells[axis]);
        let (first, last) = if imaged {
            let period = cells as f64;
            (
                (low / period).floor() as i64,
                (high / period).floor() as i64,
            )
        } else {
            (0, 0)
        };
        let size = self.grid.brick[axis];
        let lanes = self.grid.lanes_along(axis);
        let slab = self.grid.elements[axis];
        let mut spans = Vec::new();
        for image in first..=last {
            for lane in 0..lanes {
                // One more at each end, against rounding.
                let from = (image * cells + i64::from(lane * slab)) as f64;
                let [below, above] =
                    [low, high].map(|end| ((end - from) / f64::from(size)).floor());
                let end = ((above + 2.0) as u32).min(slab.div_ceil(size));
                for brick in (below - 1.0) as u32..end {
                    let start = lane * slab + brick * size;
                    let end =
                        (lane * slab + ((brick + 1) * size).min(slab)).min(self.grid.cells[axis]);
                    let shift = image * cells;
                    let reaches = (i64::from(start) + shift) as f64 <= high
                        && (i64::from(end) + shift) as f64 >= low;
                    if start < end && reaches {
                        spans.push(Span {
                            brick,
                            lane,
                            cell: (i64::from(start) + shift) as i32,
                            inside: end - start,
                        });
                    }
                }
            }
        }
        spans
    }
}

/// Distance that a point of a block may move before the next search for its tiles, cells. Tiles extend by it
/// beyond the block: a larger value costs empty tiles, a smaller one searches.
pub const SKIN: f64 = 1.0;
/// A block changes the relaxation of adjacent cells: one cell beyond the block.
pub const NEIGHBOURS: f64 = 1.0;

/// Bits of a segment that number its first tile: `SEGMENT_SHIFT` of the kernel. Those above count the tiles after it.
const SEGMENT_SHIFT: u32 = 28;
/// Largest number of tiles of a segment.
pub const MAX_SEGMENT: u32 = 1 << (u32::BITS - SEGMENT_SHIFT);

/// Tiles by block, brick and part.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// Tiles of each block.
    found: Vec<Found>,
    /// All tiles, by block.
    pub tiles: Vec<Tile>,
    /// Bricks with blocks.
    pub bricks: Vec<u32>,
    /// Tiles of each block.
    pub block_first: Vec<u32>,
    /// Start in `lane_tiles` of the tiles of each lane of a brick with blocks, slot · lanes + lane.
    pub lane_first: Vec<u32>,
    /// Tiles by lane.
    pub lane_tiles: Vec<u32>,
    /// Number of lanes of a brick.
    lanes: u32,
    /// Index of each brick of the grid in `bricks`.
    slot_of: Vec<u32>,
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
    /// An empty plan for a number of blocks.
    pub fn new(blocks: usize) -> Self {
        Self {
            found: vec![Found::default(); blocks],
            ..Self::default()
        }
    }

    /// Whether a block may have left its tiles since their search.
    pub fn has_strayed(&self, block: usize, pose: &Pose, radius: f64, cell: f64) -> bool {
        self.stray(block, pose, radius, cell) > SKIN
    }

    /// Upper bound of the displacement of the points of a block since the search for its tiles, cells.
    fn stray(&self, block: usize, pose: &Pose, radius: f64, cell: f64) -> f64 {
        let Some(then) = &self.found[block].pose else {
            return f64::INFINITY;
        };
        let change = pose.deformation - then.deformation;
        let columns = [change.x_axis, change.y_axis, change.z_axis];
        let square: f64 = columns.iter().map(|c| c.length_squared()).sum();
        ((pose.centre - then.centre).length() + square.sqrt() * radius) / cell
    }

    /// The pose at the last search for the tiles of a block.
    pub fn found_at(&self, block: usize) -> Option<Pose> {
        self.found[block].pose
    }

    /// Discards the tiles of a block.
    pub fn forget(&mut self, block: usize) {
        self.found[block] = Found::default();
    }

    /// Finds the tiles of a block and of `margin` cells around it anew if it has gone far enough for that to be due soon.
    pub fn find(
        &mut self,
        tiling: &Tiling,
        block: usize,
        (pose, radius, cell): (&Pose, f64, f64),
        (outlines, margin, imaged): (&[Outline], f64, [bool; 3]),
        first_part: u32,
    ) {
        if self.stray(block, pose, radius, cell) < 0.5 * SKIN {
            return;
        }
        let mut tiles = tiling.tiles_of_block(outlines, margin + SKIN, imaged);
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
        let slot_of = &mut self.slot_of;
        slot_of.resize(grid.bricks().iter().product::<u32>() as usize, NONE);
        for brick in &self.bricks {
            slot_of[*brick as usize] = NONE;
        }
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

    /// The tiles of the first `blocks` blocks in segments of at most `most`, as `reduce_tiles` reads them, and the segments
    /// before each block, and all.
    pub fn segments(&self, blocks: usize, most: u32) -> (Vec<u32>, Vec<u32>) {
        let (mut segments, mut block_first) = (Vec::new(), vec![0]);
        for block in 0..blocks {
            let tiles = self.tiles_of(block);
            for first in tiles.clone().step_by(most as usize) {
                let after = (tiles.end - first).min(most) - 1;
                segments.push(first | after << SEGMENT_SHIFT);
            }
            block_first.push(segments.len() as u32);
        }
        (segments, block_first)
    }

    /// Tiles of a block.
    pub fn tiles_of(&self, block: usize) -> Range<u32> {
        self.block_first[block]..self.block_first[block + 1]
    }

    /// Lanes of bricks in which the blocks have tiles, ascending.
    pub fn lanes_of(&self, blocks: &[usize]) -> Vec<u32> {
        // A brick that is listed has a tile.
        if self.lanes == 1 && blocks.len() + 1 == self.block_first.len() {
            return (0..self.lane_count() as u32).collect();
        }
        let mut taken = vec![false; self.lane_count()];
        for &block in blocks {
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
