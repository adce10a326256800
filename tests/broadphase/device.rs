//! The device's list is that of every pair tried, bit for bit.

use crate::{
    rig::Rig,
    scenes::{brute_force, item, scattered},
};
use riprap::broadphase::{Broadphase, DeviceBroadphase, HostBroadphase, Item};

struct Both {
    rig: Rig,
    device: DeviceBroadphase,
}

impl Both {
    fn new() -> Self {
        let rig = Rig::new();
        Self {
            device: DeviceBroadphase::new(&rig.device, &rig.queue).unwrap(),
            rig,
        }
    }

    /// The list of the device, which is that of the host.
    fn pairs(&mut self, items: &[Item]) -> Vec<[u32; 2]> {
        let found = self.rig.wait(self.device.pairs(items)).unwrap();
        let host = pollster::block_on(HostBroadphase.pairs(items)).unwrap();
        assert!(
            found == host,
            "device: {} pairs, host: {}",
            found.len(),
            host.len()
        );
        found
    }
}

#[test]
fn finds_what_brute_force_finds() {
    let mut both = Both::new();
    for count in [0, 1, 2, 3, 101, 997, 10_007] {
        for ratio in [1.0, 10.0, 100.0] {
            let items = scattered(count, ratio, u64::from(count));
            let found = both.pairs(&items);
            if count < 5000 {
                assert!(found == brute_force(&items), "{count} items, 1:{ratio}");
            }
            assert!(count < 100 || found.len() > count as usize / 10);
        }
    }
}

/// 70 000 fixed boxes in one cell and a small one: nine times as many candidates as an invocation
/// takes, more than the 65 535 turns after which lavapipe ends loops.
#[test]
fn a_box_may_have_more_candidates_than_loops_may_have_turns() {
    let mut items = vec![item([0.0; 3], [1.0; 3], 0); 70_000];
    items.push(item([0.4; 3], [0.2; 3], 1));
    let found = Both::new().pairs(&items);
    assert_eq!(found.len(), 70_000);
    assert!(found.iter().zip(0..).all(|(pair, n)| *pair == [n, 70_000]));
}
