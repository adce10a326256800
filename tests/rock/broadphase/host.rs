//! The host's list is that of every pair tried, on any number of threads.

use super::finders::on_host;
use kit::broadphase::{brute_force, scattered};

#[test]
fn finds_what_brute_force_finds() {
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
