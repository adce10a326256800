//! The host's list is that of every pair tried.

use crate::scenes::{brute_force, scattered};
use riprap::broadphase::{Broadphase, HostBroadphase, Item};

fn found(items: &[Item]) -> Vec<[u32; 2]> {
    pollster::block_on(HostBroadphase.pairs(items)).unwrap()
}

#[test]
fn finds_what_brute_force_finds() {
    for count in [0, 1, 2, 47, 48, 49, 101, 997, 5003] {
        for ratio in [1.0, 10.0, 100.0] {
            let items = scattered(count, ratio, u64::from(count));
            let expected = brute_force(&items);
            assert!(found(&items) == expected, "{count} items, 1:{ratio}");
            assert!(count < 100 || expected.len() > count as usize / 10);
        }
    }
}
