//! A slow but simple reference implementation of the tiling: parts on a grid, cut into tiles one after the other.

use glam::{DQuat, DVec3};
use kit::Random;
use riprap::{
    geometry::{HalfSpace, Polyhedron},
    lattice::Grid,
    psm::{PLANES, Part, Tile},
};

/// A uniformly distributed random rotation (Shoemake 1992).
pub fn rotation(random: &mut Random) -> DQuat {
    let [u, v, w] = random.point().to_array();
    let [v, w] = [v, w].map(|x| x * std::f64::consts::TAU);
    let (a, b) = ((1.0 - u).sqrt(), u.sqrt());
    DQuat::from_xyzw(a * v.sin(), a * v.cos(), b * w.sin(), b * w.cos())
}

/// A convex part on the grid, cells.
#[derive(Clone, Debug)]
pub struct Placed {
    pub centre: DVec3,
    /// Faces relative to the centre; none for a ball.
    pub faces: Vec<HalfSpace>,
    pub radius: f64,
    pub low: DVec3,
    pub high: DVec3,
    pub volume: f64,
    pub block: u32,
}

impl Placed {
    pub fn hull(block: u32, shape: &Polyhedron, centre: DVec3, rotation: DQuat) -> Self {
        let turn = |face: &HalfSpace| HalfSpace {
            normal: rotation * face.normal,
            distance: face.distance,
        };
        let corners = || shape.vertices().iter().map(|v| rotation * *v);
        Self {
            centre,
            faces: shape.faces().iter().map(turn).collect(),
            radius: 0.0,
            low: corners().fold(DVec3::INFINITY, DVec3::min),
            high: corners().fold(DVec3::NEG_INFINITY, DVec3::max),
            volume: shape.volume(),
            block,
        }
    }

    pub fn ball(block: u32, radius: f64, centre: DVec3) -> Self {
        Self {
            centre,
            faces: Vec::new(),
            radius,
            low: DVec3::splat(-radius),
            high: DVec3::splat(radius),
            volume: 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3),
            block,
        }
    }
}

/// The centre of a cell.
pub fn centre(cell: [i32; 3]) -> DVec3 {
    DVec3::from_array(cell.map(f64::from)) + 0.5
}

/// Splits a position into whole cells and the rest.
pub fn split(at: DVec3) -> ([i32; 3], [f32; 3]) {
    let base = at.floor();
    (
        base.to_array().map(|x| x as i32),
        (at - base).as_vec3().to_array(),
    )
}

pub fn grid(cells: [u32; 3], lanes: u32, brick: [u32; 3]) -> Grid {
    let [x, y, z] = cells;
    Grid {
        cells,
        elements: [x, y, z.div_ceil(lanes)],
        lanes,
        lane_axis: 2,
        brick,
    }
}

pub struct Tiling {
    pub grid: Grid,
    /// First cell of the domain in the coordinates of the parts.
    pub origin: [i32; 3],
    pub placed: Vec<Placed>,
    pub parts: Vec<Part>,
    pub faces: Vec<[f32; 4]>,
    pub tiles: Vec<Tile>,
    pub slots: u32,
}

/// Tiles exist wherever a part is nearer to a brick than two cells.
const REACH: f64 = 2.0;

impl Tiling {
    /// Parts sorted by block; all bricks are saturated, the last one being the first slot.
    pub fn new(grid: Grid, origin: [i32; 3], placed: Vec<Placed>) -> Self {
        let mut all = Self {
            grid,
            origin,
            parts: Vec::new(),
            faces: Vec::new(),
            tiles: Vec::new(),
            slots: grid.bricks().iter().product(),
            placed: Vec::new(),
        };
        for (number, part) in (0..).zip(&placed) {
            let (base, fraction) = split(part.centre);
            all.parts.push(Part {
                base,
                first_face: all.faces.len() as u32,
                fraction,
                faces: part.faces.len() as u32,
                low: part.low.as_vec3().to_array(),
                radius: part.radius as f32,
                high: part.high.as_vec3().to_array(),
                block: part.block,
            });
            for face in &part.faces {
                let row = face.normal.extend(face.distance).as_vec4().to_array();
                all.faces.push(row);
            }
            for slot in 0..all.slots {
                for lane in 0..grid.lanes {
                    all.tile(number, part, slot, lane);
                }
            }
        }
        // No buffer is empty.
        all.faces.push([f32::NAN; 4]);
        all.placed = placed;
        all
    }

    fn tile(&mut self, number: u32, part: &Placed, slot: u32, lane: u32) {
        let grid = &self.grid;
        let [bx, by, _] = grid.bricks();
        let brick = self.slots - 1 - slot;
        let at = [brick % bx, brick / bx % by, brick / (bx * by)];
        let first = [0, 1, 2].map(|a| at[a] * grid.brick[a]);
        let slices = grid.elements[2];
        let lowest = [first[0], first[1], first[2] + lane * slices];
        // Elements after the last slice are not cells of the lane, and cells after the last one are not in the domain.
        let end = [
            grid.cells[0],
            grid.cells[1],
            ((lane + 1) * slices).min(grid.cells[2]),
        ];
        let inside = [0, 1, 2].map(|a| end[a].saturating_sub(lowest[a]).min(grid.brick[a]));
        let cell = [0, 1, 2].map(|a| self.origin[a] + lowest[a] as i32);
        let low = centre(cell) - 0.5 - part.centre - REACH;
        let size = DVec3::from_array(grid.brick.map(f64::from));
        let high = low + size + 2.0 * REACH;
        if low.cmplt(part.high).all() && high.cmpgt(part.low).all() {
            self.tiles.push(Tile {
                cell,
                part: number,
                block: part.block,
                slot,
                lane,
                inside: Tile::pack(inside),
            });
        }
    }

    pub fn workgroup(&self) -> usize {
        self.grid.brick.iter().product::<u32>() as usize
    }

    /// The cell of element `local` of a tile; `None` beyond the domain.
    pub fn cell(&self, tile: &Tile, local: usize) -> Option<[i32; 3]> {
        let [x, y, _] = self.grid.brick.map(|n| n as usize);
        let place = [local % x, local / x % y, local / (x * y)].map(|n| n as u32);
        let inside = [0, 8, 16].map(|shift| tile.inside >> shift & 255);
        let here = (0..3).all(|a| place[a] < inside[a]);
        let cell = [0, 1, 2].map(|a| tile.cell[a] + place[a] as i32);
        here.then_some(cell)
    }

    /// Sets a random range of elements that the part of each tile can reach.
    pub fn shorten(&mut self, noise: &mut Random) {
        for tile in &mut self.tiles {
            let mut any = |most: u32| (noise.unit() * f64::from(most)) as u32;
            let first = any(Tile::EIGHTHS);
            *tile = tile.reaching([first, first + 1 + any(Tile::EIGHTHS - first)]);
        }
    }

    /// Elements that the part of a tile can reach.
    pub fn reach(&self, tile: &Tile) -> std::ops::Range<usize> {
        let eighth = self.workgroup().div_ceil(8);
        let end = |bits: u32| eighth * (bits & 15) as usize;
        end(tile.inside >> 24)..end(tile.inside >> 28)
    }

    /// The smallest range that contains all elements that parts can reach in a lane of a slot.
    pub fn reach_of_lane(&self, slot: u32, lane: u32) -> std::ops::Range<usize> {
        let here = |tile: &&Tile| (tile.slot, tile.lane) == (slot, lane);
        let tiles = self.tiles.iter().filter(here);
        let reaches = tiles.map(|tile| self.reach(tile));
        let all = reaches.reduce(|a, b| a.start.min(b.start)..a.end.max(b.end));
        all.unwrap_or(0..0)
    }

    /// Index of a scalar of the saturation.
    pub fn scalar(&self, tile: &Tile, plane: usize, local: usize) -> usize {
        let lanes = self.grid.lanes as usize;
        let element = (tile.slot as usize * PLANES + plane) * self.workgroup() + local;
        element * lanes + tile.lane as usize
    }

    /// Tiles of each lane of a slot in ascending order, and their first positions.
    pub fn by_lane(&self) -> (Vec<u32>, Vec<u32>) {
        let (mut first, mut list) = (vec![0], Vec::new());
        for lane in 0..self.slots * self.grid.lanes {
            let here = |t: &Tile| t.slot * self.grid.lanes + t.lane == lane;
            let numbers = (0..).zip(&self.tiles).filter(|(_, t)| here(t));
            list.extend(numbers.map(|(n, _)| n as u32));
            first.push(list.len() as u32);
        }
        list.push(u32::MAX);
        (first, list)
    }

    /// Number of tiles before each of `blocks` blocks, and of all.
    pub fn by_block(&self, blocks: u32) -> Vec<u32> {
        let before = |block| self.tiles.iter().filter(|t| t.block < block).count() as u32;
        (0..=blocks).map(before).collect()
    }
}
