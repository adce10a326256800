//! Caches and used resolvers save time and change nothing.

use glam::DQuat;
use kit::contact::{Couple, Random};
use riprap::rock::contact::{Cache, Options, Resolver, Verdict};

/// Pairs that move through contact and out of it, each step with the cache and without.
#[test]
fn a_moving_pair_is_the_same_cold_and_warm() {
    let mut random = Random(11);
    let mut warm = Resolver::new(Options::default());
    let mut cold = Resolver::new(Options::default());
    let mut verdicts = [0, 0];
    for _ in 0..60 {
        let mut couple = Couple::random(&mut random, 5.0, -2e-4);
        let mut cache = Cache::default();
        let way = random.vector() * 5e-5 * couple.length;
        let turn = DQuat::from_scaled_axis(random.vector() * 5e-5);
        for _ in 0..20 {
            couple.centres[1] += way;
            couple.rotations[1] = (turn * couple.rotations[1]).normalize();
            let [a, b] = couple.placed();
            let with = warm.resolve(&a, &b, &mut cache).unwrap();
            let without = cold.resolve(&a, &b, &mut Cache::default()).unwrap();
            match (with, without) {
                (Verdict::Contact(with), Verdict::Contact(without)) => {
                    verdicts[0] += 1;
                    let length = couple.length;
                    assert!((with.point - without.point).length() < 1e-8 * length);
                    assert!((with.normal - without.normal).length() < 1e-7);
                    assert!((with.overlap - without.overlap).abs() < 1e-7 * without.overlap);
                    assert!((with.area - without.area).abs() <= 1e-6 * without.area);
                }
                (with, without) => {
                    verdicts[1] += 1;
                    assert_eq!(with, without);
                }
            }
        }
    }
    assert!(verdicts.iter().all(|n| *n > 100), "{verdicts:?}");
    let (warm, cold) = (warm.counts(), cold.counts());
    assert!(warm.programs * 5 < cold.programs, "{warm:?} {cold:?}");
}

/// A cache of another pair, or of numbers without meaning, costs time at most.
#[test]
fn a_wrong_cache_changes_no_verdict() {
    let mut random = Random(12);
    let mut resolver = Resolver::new(Options::default());
    for round in 0..600 {
        let size = random.magnitude(1e-8, 1e-2);
        let gap = if round % 2 == 0 { -size } else { size };
        let couple = Couple::random(&mut random, 5.0, gap);
        let [a, b] = couple.placed();
        let fresh = resolver.resolve(&a, &b, &mut Cache::default()).unwrap();
        let mut wrong = Cache {
            plane: random.vector().to_array(),
            point: random.vector().to_array(),
            contact: random.below(2) == 0,
            second: random.below(2) == 0,
        };
        let found = resolver.resolve(&a, &b, &mut wrong).unwrap();
        let contact = |verdict| matches!(verdict, Verdict::Contact(_));
        assert_eq!(contact(fresh), contact(found));
    }
}

/// Threads share out the pairs as it comes: bits must not depend on what a resolver did before.
#[test]
fn a_used_resolver_gives_the_bits_of_a_new_one() {
    let mut random = Random(13);
    let mut used = Resolver::new(Options::default());
    for _ in 0..300 {
        let gap = random.between(-1e-3, 1e-3);
        let couple = Couple::random(&mut random, 3.0, gap);
        let [a, b] = couple.placed();
        let (mut cache, mut other) = (Cache::default(), Cache::default());
        let old = used.resolve(&a, &b, &mut cache).unwrap();
        let new = Resolver::new(Options::default())
            .resolve(&a, &b, &mut other)
            .unwrap();
        assert_eq!(old, new);
        assert_eq!(cache, other);
    }
}
