//! Which finder of pairs a scene of blocks runs with.

use riprap::{
    Result,
    broadphase::{Broadphase, Item},
    scene::Scene,
    simulation::Dry,
};

pub struct Finder;

impl Finder {
    pub fn describe(&self) -> String {
        "on the host".into()
    }
}

impl Broadphase for Finder {
    async fn pairs(&mut self, items: &[Item]) -> Result<Vec<[u32; 2]>> {
        let mut order: Vec<u32> = (0..items.len() as u32).collect();
        order.sort_by(|a, b| items[*a as usize].min[0].total_cmp(&items[*b as usize].min[0]));
        let mut pairs = Vec::new();
        for (at, &i) in order.iter().enumerate() {
            for &j in &order[at + 1..] {
                let (a, b) = (&items[i as usize], &items[j as usize]);
                if b.min[0] > a.max[0] {
                    break;
                }
                if a.group != b.group && a.overlaps(b) {
                    pairs.push([i.min(j), i.max(j)]);
                }
            }
        }
        pairs.sort_unstable();
        Ok(pairs)
    }
}

pub fn open(scene: &Scene, _adapter: Option<&str>) -> Result<Dry<Finder>> {
    pollster::block_on(Dry::new(scene, Finder))
}

pub fn drive(simulation: &mut Dry<Finder>, steps: u64) -> Result<()> {
    pollster::block_on(simulation.advance(steps))
}
