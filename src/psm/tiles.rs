//! Which bricks a convex part reaches.

use super::Tile;
use crate::lattice::Grid;
use glam::DVec3;

/// A convex part where it is, cells.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outline {
    /// Centroid, from the lower corner of the domain.
    pub centre: DVec3,
    /// Corners of the box around it, from the centroid.
    pub low: DVec3,
    /// See `low`.
    pub high: DVec3,
    /// Outward unit normal and distance from the centroid; none: a sphere.
    pub faces: Vec<(DVec3, f64)>,
    /// Radius of a sphere.
    pub radius: f64,
}

impl Outline {
    /// Whether a box of half extents `half` around `middle` (from the centroid) lies off it for sure.
    fn is_off(&self, middle: DVec3, half: DVec3) -> bool {
        if (middle + half).cmplt(self.low).any() || (middle - half).cmpgt(self.high).any() {
            return true;
        }
        if self.faces.is_empty() {
            let gap = (middle.abs() - half).max(DVec3::ZERO);
            return gap.length_squared() > self.radius * self.radius;
        }
        let faces = self.faces.iter();
        faces
            .map(|(normal, distance)| normal.dot(middle) - distance - normal.abs().dot(half))
            .any(|gap| gap > 0.0)
    }
}

/// How much longer than a period a block is that has no images, cells: rounding.
const LONGER: f64 = 1e-6;

/// Along which of the `periodic` axes of a domain of `cells` cells a block, whose parts are `outlines`, has images:
/// those that it does not fill. One that is longer than a period is in the domain as it lies there.
pub fn imaged(outlines: &[Outline], cells: [u32; 3], periodic: [bool; 3]) -> [bool; 3] {
    [0, 1, 2].map(|axis| {
        let ends = |of: &Outline| [of.low, of.high].map(|end| of.centre[axis] + end[axis]);
        let widen = |[low, high]: [f64; 2], of: &Outline| {
            let [from, to] = ends(of);
            [low.min(from), high.max(to)]
        };
        let [low, high] = outlines
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], widen);
        periodic[axis] && high - low <= f64::from(cells[axis]) + LONGER
    })
}

/// The bricks of an axis that an interval reaches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Span {
    brick: u32,
    lane: u32,
    /// Lowest cell, shifted by whole periods.
    cell: i32,
    /// Its cells that lie in the domain.
    inside: u32,
}

/// Where the tiles of a grid are.
#[derive(Clone, Copy, Debug)]
pub struct Tiling {
    grid: Grid,
    periodic: [bool; 3],
}

impl Tiling {
    /// Of a grid with periodic axes.
    pub fn new(grid: Grid, periodic: [bool; 3]) -> Self {
        Self { grid, periodic }
    }

    /// Cells of the domain, and which of its axes are periodic.
    pub fn domain(&self) -> ([u32; 3], [bool; 3]) {
        (self.grid.cells, self.periodic)
    }

    /// The tiles of a block's parts, each part with its number from 0 and grown by `margin` cells, without their slots,
    /// each with its brick; in the order of parts, bricks and lanes.
    pub fn tiles_of_block(&self, outlines: &[Outline], margin: f64) -> Vec<(u32, Tile)> {
        let imaged = imaged(outlines, self.grid.cells, self.periodic);
        let parts = (0..).zip(outlines);
        let tiles = parts.flat_map(|(part, outline)| {
            let tiles = self.tiles(outline, margin, imaged).into_iter();
            tiles.map(move |(brick, tile)| (brick, Tile { part, ..tile }))
        });
        tiles.collect()
    }

    /// The tiles of a part, with its images along axes where it is `imaged`.
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
                        lane: z.lane,
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
        let brick = self.grid.brick;
        let cells: u32 = brick.iter().product();
        let corner = DVec3::from_array(cell.map(f64::from)) - outline.centre;
        let place = |k: u32| {
            [
                k % brick[0],
                k / brick[0] % brick[1],
                k / (brick[0] * brick[1]),
            ]
        };
        let reaches = |eighth: &u32| {
            let size = cells.div_ceil(Tile::EIGHTHS);
            let [first, last] = [eighth * size, (eighth + 1) * size].map(|end| end.min(cells));
            if first == last {
                return false;
            }
            let [first, last] = [place(first), place(last - 1)];
            // Rows that it holds a part of count as whole ones, and so do layers.
            let whole = [first[1..] != last[1..], first[2] != last[2], false];
            let side = |axis: usize| match whole[axis] {
                true => [0, inside[axis]],
                false => [first[axis], (last[axis] + 1).min(inside[axis])],
            };
            let sides = [0, 1, 2].map(side);
            let [low, high] =
                [0, 1].map(|end| DVec3::from_array(sides.map(|side| side[end].into())));
            let half = 0.5 * (high - low);
            half.min_element() > 0.0
                && !outline.is_off(corner + low + half, half + DVec3::splat(margin))
        };
        let first = (0..Tile::EIGHTHS).find(reaches)?;
        let last = (first..Tile::EIGHTHS).rfind(reaches)?;
        Some([first, last + 1])
    }

    /// Spans of bricks between `low` and `high` on an axis, and periods away where what lies there is `imaged`.
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
        let lanes = if axis == 2 { self.grid.lanes } else { 1 };
        let slab = self.grid.elements[axis];
        let mut spans = Vec::new();
        for image in first..=last {
            for lane in 0..lanes {
                for brick in 0..slab.div_ceil(size) {
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
