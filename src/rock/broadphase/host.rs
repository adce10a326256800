//! Williams, Perkins & Cook 2004, Eng. Comput. 21:235, CGRID, with a grid for each size: every
//! box lies in the cell of its level that contains its lower corner, and is compared with the boxes in those
//! cells of its own and all coarser levels from which a box can reach it.

use super::{Aabb, Boxes, Broadphase, exact_pairs};
use crate::{
    Result,
    gpu::bins::{DeviceBox, Level, buckets},
};
use rayon::prelude::*;

/// Number of boxes up to which every pair is compared, at less than half the cost of cells. Cells are faster from 350
/// boxes of one size and 1000 of sizes 1:100; in between they cost some ten microseconds more, but scale linearly with
/// the number.
const BRUTE_FORCE_MAX: usize = 64;

/// Number of items per task.
const BOXES_PER_TASK: usize = 1024;

/// Finds pairs on the host, in O(N) for any mixture of sizes, on several threads from a few thousand
/// boxes.
#[derive(Clone, Copy, Debug, Default)]
pub struct HostBroadphase;

impl Broadphase for HostBroadphase {
    async fn pairs(&mut self, aabbs: &[Aabb]) -> Result<Vec<[u32; 2]>> {
        let boxes = Boxes::new(aabbs)?;
        if aabbs.len() <= BRUTE_FORCE_MAX {
            return Ok(brute_force(aabbs));
        }
        let bins = Bins::new(&boxes);
        let found = bins.entries.par_chunks(BOXES_PER_TASK).map(|run| {
            let mut found = Vec::with_capacity(4 * run.len());
            for entry in run {
                bins.search_from(entry, &mut found);
            }
            found
        });
        let found = found.collect::<Vec<_>>().concat();
        Ok(exact_pairs(aabbs, &found))
    }
}

/// Compares every pair.
fn brute_force(aabbs: &[Aabb]) -> Vec<[u32; 2]> {
    let mut found = Vec::new();
    for (i, first) in (0..).zip(aabbs) {
        for (j, second) in (i + 1..).zip(&aabbs[i as usize + 1..]) {
            if first.pairs_with(second) {
                found.push([i, j]);
            }
        }
    }
    found
}

/// Boxes sorted into a hash table of cells.
struct Bins<'a> {
    levels: &'a [Level],
    /// All buckets, and one more that marks the end of the boxes.
    buckets: Vec<Bucket>,
    entries: Vec<DeviceBox>,
}

/// Cells that share a place in the hash table.
#[derive(Clone, Copy)]
struct Bucket {
    /// Index of its first box.
    start: u32,
    /// Lowest and highest group of its boxes.
    groups: [u32; 2],
}

impl<'a> Bins<'a> {
    fn new(Boxes { boxes, levels }: &'a Boxes) -> Self {
        let count = buckets(boxes.len() as u32) as usize;
        let empty = Bucket {
            start: 0,
            groups: [u32::MAX, 0],
        };
        let mut buckets = vec![empty; count + 1];
        let place = |item: &DeviceBox| {
            let level = item.level();
            bucket(cell(item.min, levels[level as usize].scale), level, count) as u32
        };
        let places: Vec<u32> = boxes.iter().map(place).collect();
        for (item, place) in boxes.iter().zip(&places) {
            let Bucket { start, groups } = &mut buckets[*place as usize];
            *start += 1;
            *groups = [groups[0].min(item.group), groups[1].max(item.group)];
        }
        let mut end = 0;
        for bucket in &mut buckets {
            end += bucket.start;
            bucket.start = end;
        }
        // From the last box to the first, so that the end of each bucket becomes its start.
        let mut entries = boxes.clone();
        for (item, place) in boxes.iter().zip(&places).rev() {
            let start = &mut buckets[*place as usize].start;
            *start -= 1;
            entries[*start as usize] = *item;
        }
        Self {
            levels,
            buckets,
            entries,
        }
    }

    /// Adds the pairs of `item` with the boxes of its level that come after it, and with those of
    /// coarser levels.
    fn search_from(&self, item: &DeviceBox, found: &mut Vec<[u32; 2]>) {
        let own = item.level();
        let own_cell = cell(item.min, self.levels[own as usize].scale);
        for (level, Level { scale, extent }) in (own..).zip(&self.levels[own as usize..]) {
            let low = cell(item.min.map(|x| x - extent), *scale);
            let high = cell(item.max, *scale);
            for z in low[2]..=high[2] {
                for y in low[1]..=high[1] {
                    for x in low[0]..=high[0] {
                        let at = [x, y, z];
                        if level > own || [z, y, x] >= [own_cell[2], own_cell[1], own_cell[0]] {
                            let half = level == own && at == own_cell;
                            self.search(item, (at, level), half, found);
                        }
                    }
                }
            }
        }
    }

    fn search(
        &self,
        item: &DeviceBox,
        (at, level): ([i32; 3], u32),
        half: bool,
        found: &mut Vec<[u32; 2]>,
    ) {
        let place = bucket(at, level, self.buckets.len() - 1);
        let Bucket { start, groups } = self.buckets[place];
        if groups == [item.group; 2] {
            return;
        }
        let number = item.number();
        for other in &self.entries[start as usize..self.buckets[place + 1].start as usize] {
            // Other levels may share the bucket. Other cells of this level may too, but their places
            // differ by multiples of 4, and at most 4 cells in a row are searched.
            if item.overlaps(other)
                && item.group != other.group
                && other.level() == level
                && !(half && other.number() <= number)
            {
                let other = other.number();
                found.push([number.min(other), number.max(other)]);
            }
        }
    }
}

/// The cell of a point.
fn cell(point: [f32; 3], scale: f32) -> [i32; 3] {
    point.map(|x| (x * scale).floor() as i32)
}

/// Spatial hashing (Teschner et al. 2003, VMV) of blocks of 4 × 4 × 4 cells, which stay together so that
/// neighbours are near in memory. The last steps mix the bits (Appleby's MurmurHash3).
fn bucket(cell: [i32; 3], level: u32, buckets: usize) -> usize {
    let [x, y, z] = cell.map(|n| (n >> 2) as u32);
    let mut h = x.wrapping_mul(73_856_093)
        ^ y.wrapping_mul(19_349_663)
        ^ z.wrapping_mul(83_492_791)
        ^ level.wrapping_mul(2_654_435_761);
    h = (h ^ h >> 16).wrapping_mul(0x85eb_ca6b);
    h = (h ^ h >> 13).wrapping_mul(0xc2b2_ae35);
    h ^= h >> 16;
    let [x, y, z] = cell.map(|n| (n & 3) as u32);
    (h.wrapping_mul(64) + 16 * z + 4 * y + x) as usize & (buckets - 1)
}
