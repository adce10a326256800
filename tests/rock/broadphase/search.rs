//! The lists of host and device equal the brute-force list, bit for bit, within the device's limits and on any number of
//! threads.

use super::{Finders, on_host};
use kit::{
    Rig,
    broadphase::{brute_force, item, scattered},
};
use riprap::{
    Error,
    rock::broadphase::{AutoBroadphase, Broadphase},
    wgpu,
};

#[test]
fn the_device_finds_what_brute_force_finds() {
    let mut finders = Finders::new();
    for count in [0, 1, 2, 3, 101, 997, 10_007] {
        for ratio in [1.0, 10.0, 100.0] {
            let items = scattered(count, ratio, u64::from(count));
            let found = finders.pairs(&items);
            if count < 5000 {
                assert!(found == brute_force(&items), "{count} items, 1:{ratio}");
            }
            assert!(count < 100 || found.len() > count as usize / 2);
        }
    }
}

/// The order in which buckets are filled is undefined; the list is the same.
#[test]
fn the_list_is_the_same_each_time() {
    let items = scattered(2003, 100.0, 8);
    let mut finders = Finders::new();
    let first = finders.pairs(&items);
    assert!(first == finders.pairs(&items));
    assert!(first == Finders::new().pairs(&items));
}

/// 70 000 fixed boxes in one cell and a small one: nine times as many candidates as an invocation
/// compares, more than the 65 535 iterations after which lavapipe ends loops.
#[test]
fn a_box_may_have_more_candidates_than_loops_may_have_turns() {
    let mut items = vec![item([0.0; 3], [1.0; 3], 0); 70_000];
    items.push(item([0.4; 3], [0.2; 3], 1));
    let found = Finders::new().pairs(&items);
    assert_eq!(found.len(), 70_000);
    assert!(found.iter().zip(0..).all(|(pair, n)| *pair == [n, 70_000]));
}

/// The same number of items with few pairs, many, few again: the buffers grow when needed, and earlier
/// contents do no harm.
#[test]
fn room_for_pairs_grows() {
    let mut finders = Finders::new();
    let apart = |n: u32| item([f64::from(n), 0.0, 0.0], [0.9; 3], n);
    let together = |n: u32| item([0.0, 0.0, -0.001 * f64::from(n)], [0.9; 3], n);
    let touching = |n: u32| item([f64::from(n), 0.0, 0.0], [1.0; 3], n);
    let scene = |of: &dyn Fn(u32) -> _| (0..401).map(of).collect::<Vec<_>>();
    for _ in 0..2 {
        assert_eq!(finders.pairs(&scene(&apart)), [[0; 2]; 0]);
        assert_eq!(finders.pairs(&scene(&touching)).len(), 400);
        assert_eq!(finders.pairs(&scene(&together)).len(), 401 * 400 / 2);
    }
}

/// 79 800 pairs where a binding holds 8192.
#[test]
fn a_list_longer_than_a_binding_comes_in_parts() {
    let limits = wgpu::Limits {
        max_storage_buffer_binding_size: 1 << 16,
        ..wgpu::Limits::default()
    };
    let mut finders = Finders::with_limits(limits.clone());
    let items: Vec<_> = (0..400).map(|n| item([0.0; 3], [1.0; 3], n)).collect();
    assert_eq!(finders.pairs(&items).len(), 79_800);
    // The boxes cannot be split into parts.
    let items = scattered(5000, 1.0, 1);
    let mut finder = Finders::with_limits(limits);
    let refused = finder.rig.wait(finder.device.pairs(&items)).unwrap_err();
    assert!(matches!(refused, Error::Limit { .. }), "{refused}");
}

/// The limits that WebGPU guarantees everywhere are sufficient.
#[test]
fn promised_limits_suffice() {
    let mut finders = Finders::with_limits(wgpu::Limits::default());
    finders.pairs(&scattered(499, 10.0, 2));
}

#[test]
fn the_chosen_finder_gives_the_same_list() {
    let items = scattered(499, 10.0, 2);
    let expected = on_host(&items).unwrap();
    let rig = Rig::new();
    let mut auto = AutoBroadphase::new(&rig.device, &rig.queue);
    for crossover in [0, 499, 500, usize::MAX] {
        auto.crossover = crossover;
        assert!(rig.wait(auto.pairs(&items)).unwrap() == expected);
    }
}

#[test]
fn the_host_finds_what_brute_force_finds() {
    for count in [0, 1, 2, 63, 64, 65, 101, 997, 2003] {
        for ratio in [1.0, 10.0, 100.0] {
            let items = scattered(count, ratio, u64::from(count));
            let expected = brute_force(&items);
            assert!(on_host(&items).unwrap() == expected, "{count}, 1:{ratio}");
            assert!(count < 100 || expected.len() > count as usize / 2);
        }
    }
}

#[test]
fn threads_do_not_change_the_list() {
    let items = scattered(10_007, 100.0, 6);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| on_host(&items).unwrap())
    };
    assert!(with(1) == with(5));
}
