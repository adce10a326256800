//! Williams, Perkins & Cook 2004, Eng. Comput. 21:235, CGRID, with a grid for each size: every
//! item lies in the one cell of its level that holds its lower corner, and looks through the cells
//! of its own and all coarser levels from which a box can reach it.

use super::{Boxes, Broadphase, Item, list};
use crate::{
    Result,
    search::{DeviceBox, Level},
};
use rayon::prelude::*;

/// Up to here trying every pair is faster than making cells.
const FEW: usize = 48;

/// Items that a thread takes at once.
const RUN: usize = 1024;

/// Finds pairs on the host, in O(N) for all mixtures of sizes; with threads from a few thousand
/// items on.
#[derive(Clone, Copy, Debug, Default)]
pub struct HostBroadphase;

impl Broadphase for HostBroadphase {
    async fn pairs(&mut self, items: &[Item]) -> Result<Vec<[u32; 2]>> {
        let boxes = Boxes::new(items)?;
        if items.len() <= FEW {
            return Ok(every(items));
        }
        let bins = Bins::new(&boxes);
        let found = bins.entries.par_chunks(RUN).map(|run| {
            let mut found = Vec::with_capacity(4 * run.len());
            for entry in run {
                bins.meet(entry, items, &mut found);
            }
            found
        });
        let found = found.collect::<Vec<_>>().concat();
        Ok(list::sort(items.len(), &found))
    }
}

/// Every pair tried.
fn every(items: &[Item]) -> Vec<[u32; 2]> {
    let mut found = Vec::new();
    for (i, first) in (0..).zip(items) {
        for (j, second) in (i + 1..).zip(&items[i as usize + 1..]) {
            if first.pairs_with(second) {
                found.push([i, j]);
            }
        }
    }
    found
}

/// Boxes sorted into a table of cells.
struct Bins<'a> {
    levels: &'a [Level],
    /// Where the boxes of each bucket begin; one more than there are buckets.
    starts: Vec<u32>,
    /// Lowest and highest group in each bucket.
    groups: Vec<[u32; 2]>,
    entries: Vec<DeviceBox>,
}

impl<'a> Bins<'a> {
    fn new(boxes: &'a Boxes) -> Self {
        let buckets = (2 * boxes.boxes.len()).next_power_of_two();
        let mut starts = vec![0u32; buckets + 1];
        let mut groups = vec![[u32::MAX, 0]; buckets];
        let of: Vec<_> = boxes
            .boxes
            .iter()
            .map(|item| {
                let level = item.level();
                let cell = cell(item.min, boxes.levels[level as usize].scale);
                bucket(cell, level, buckets)
            })
            .collect();
        for (item, &bucket) in boxes.boxes.iter().zip(&of) {
            starts[bucket + 1] += 1;
            let [low, high] = &mut groups[bucket];
            (*low, *high) = (item.group.min(*low), item.group.max(*high));
        }
        for n in 0..buckets {
            starts[n + 1] += starts[n];
        }
        let mut next = starts.clone();
        let mut entries = boxes.boxes.clone();
        for (item, &bucket) in boxes.boxes.iter().zip(&of) {
            entries[next[bucket] as usize] = *item;
            next[bucket] += 1;
        }
        Self {
            levels: &boxes.levels,
            starts,
            groups,
            entries,
        }
    }

    /// Adds the pairs of `item` with the items of its level that come after it, and with those of
    /// coarser levels.
    fn meet(&self, item: &DeviceBox, items: &[Item], found: &mut Vec<[u32; 2]>) {
        let own = item.level();
        let home = cell(item.min, self.levels[own as usize].scale);
        for (level, Level { scale, extent }) in (own..).zip(&self.levels[own as usize..]) {
            let low = cell(item.min.map(|x| x - extent), *scale);
            let high = cell(item.max, *scale);
            for z in low[2]..=high[2] {
                for y in low[1]..=high[1] {
                    for x in low[0]..=high[0] {
                        let at = [x, y, z];
                        if level > own || [z, y, x] >= [home[2], home[1], home[0]] {
                            let half = level == own && at == home;
                            self.search(item, items, (at, level), half, found);
                        }
                    }
                }
            }
        }
    }

    fn search(
        &self,
        item: &DeviceBox,
        items: &[Item],
        (at, level): ([i32; 3], u32),
        half: bool,
        found: &mut Vec<[u32; 2]>,
    ) {
        let bucket = bucket(at, level, self.groups.len());
        if self.groups[bucket] == [item.group; 2] {
            return;
        }
        let number = item.number();
        for other in &self.entries[self.starts[bucket] as usize..self.starts[bucket + 1] as usize] {
            // Other cells may share the bucket; a pair counts in the cell of the other only.
            if item.overlaps(other)
                && item.group != other.group
                && other.level() == level
                && !(half && other.number() <= number)
                && cell(other.min, self.levels[level as usize].scale) == at
                && items[number as usize].overlaps(&items[other.number() as usize])
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

/// Teschner et al. 2003, VMV: spatial hashing; the last steps mix the bits (Appleby's MurmurHash3).
fn bucket([x, y, z]: [i32; 3], level: u32, buckets: usize) -> usize {
    let mut h = (x as u32).wrapping_mul(73_856_093)
        ^ (y as u32).wrapping_mul(19_349_663)
        ^ (z as u32).wrapping_mul(83_492_791)
        ^ level.wrapping_mul(2_654_435_761);
    h = (h ^ h >> 16).wrapping_mul(0x85eb_ca6b);
    h = (h ^ h >> 13).wrapping_mul(0xc2b2_ae35);
    (h ^ h >> 16) as usize & (buckets - 1)
}
