//! Plugs a custom broadphase into riprap.
//!
//! Blocks in a row along x need no grid: sorted by their lower corner, each is only tested against those that begin before
//! it ends. The list equals that of riprap's own broadphase, and the states of the blocks are bitwise equal; otherwise the
//! program fails.
//!
//! `cargo run --release -p riprap-harness --example own_broadphase`

use glam::DVec3;
use riprap::{
    geometry::{Polyhedron, Shape},
    rock::{
        Block, Blocks, Material, Setup,
        broadphase::{Aabb, Broadphase, HostBroadphase},
    },
};
use std::{error::Error, sync::Arc};

/// Sweep and prune along x.
#[derive(Default)]
struct Sweep {
    /// Number of calls.
    calls: u32,
}

impl Broadphase for Sweep {
    // Nothing here waits; a broadphase on a device would.
    async fn pairs(&mut self, items: &[Aabb]) -> riprap::Result<Vec<[u32; 2]>> {
        self.calls += 1;
        let mut order: Vec<usize> = (0..items.len()).collect();
        order.sort_by(|&a, &b| items[a].min[0].total_cmp(&items[b].min[0]));
        let mut pairs = Vec::new();
        for (k, &i) in order.iter().enumerate() {
            let end = items[i].max[0];
            for &j in order[k + 1..]
                .iter()
                .take_while(|&&j| items[j].min[0] <= end)
            {
                // Items of one group never pair: the parts of one block, and all fixed blocks.
                if items[i].group != items[j].group && items[i].overlaps(&items[j]) {
                    pairs.push([i.min(j) as u32, i.max(j) as u32]);
                }
            }
        }
        // The contract: i < j, sorted, each once.
        pairs.sort_unstable();
        Ok(pairs)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut own = Sweep::default();
    let mut ours = row()?;
    pollster::block_on(ours.advance(&mut own, 0.5))?;
    let mut theirs = row()?;
    pollster::block_on(theirs.advance(&mut HostBroadphase, 0.5))?;
    println!(
        "{} blocks, {} candidate pairs, {} lists in {:.1} s",
        ours.len(),
        ours.candidate_pair_count(),
        own.calls,
        ours.time()
    );
    if ours.snapshot() == theirs.snapshot() {
        Ok(())
    } else {
        Err("the two broadphases lead to different states".into())
    }
}

/// A hundred cubes in a row, which fall onto a floor from different heights.
fn row() -> riprap::Result<Blocks> {
    let cube: Arc<Shape> = Arc::new(Polyhedron::cuboid(DVec3::ONE)?.into());
    let floor: Arc<Shape> = Arc::new(Polyhedron::cuboid(DVec3::new(200.0, 4.0, 1.0))?.into());
    let mut list = vec![Block::new("floor", floor, DVec3::Z * -0.5).fixed()];
    for i in 0..100 {
        let height = 0.5 + 0.05 * f64::from(i % 7);
        let at = DVec3::new(1.5 * (f64::from(i) - 50.0), 0.0, height);
        list.push(Block::new(format!("cube {i}"), cube.clone(), at));
    }
    Blocks::new(Setup {
        blocks: list,
        materials: vec![Material::default()],
        ..Setup::default()
    })
}
