//! Caches and used resolvers save time and change no result; the cache of a pair that is apart keeps a separating plane.

use glam::{DQuat, DVec3};
use kit::{
    assert_near,
    contact::{Couple, Random},
};
use riprap::rock::contact::{Cache, Options, Resolver, Verdict};

/// Pairs that move into contact and out of it, each step with the cache and without.
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
                    assert_near(with.overlap, without.overlap, 1e-7 * without.overlap);
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

/// A cache of another pair, or of meaningless numbers, costs time at most.
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

/// Pairs are distributed over threads in no fixed order: bits must not depend on what a resolver did before.
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

#[test]
fn the_cached_plane_has_each_block_on_its_own_side() {
    let mut random = Random(2);
    let mut resolver = Resolver::new(Options::default());
    let mut planes = 0;
    for _ in 0..2000 {
        let gap = random.magnitude(1e-9, 0.02);
        let couple = Couple::random(&mut random, 20.0, gap);
        let [a, b] = couple.placed();
        let mut cache = Cache::default();
        assert_eq!(
            resolver.resolve(&a, &b, &mut cache).unwrap(),
            Verdict::Apart
        );
        let kept = DVec3::from_array(cache.plane);
        if kept == DVec3::ZERO {
            continue; // Bounding spheres.
        }
        planes += 1;
        let (holder, other) = if cache.second { (&b, &a) } else { (&a, &b) };
        let n = holder.deformation * kept;
        let height = |v: &DVec3| n.dot(*v);
        let top = holder.vertices.iter().map(height).fold(f64::MIN, f64::max);
        let shift = other.centre - holder.centre;
        let foot = other.vertices.iter().map(|v| n.dot(*v + shift));
        let between = foot.fold(f64::MAX, f64::min) - top;
        assert!(
            between > 0.0,
            "gap {gap} L, along the plane's normal {between} m"
        );
        // No direction has a larger gap than the distance.
        assert!(between <= gap * couple.length * n.length() + 1e-12 * couple.length);
    }
    assert!(planes > 1500, "{planes}");
}

#[test]
fn a_plane_that_holds_saves_the_linear_program() {
    let mut random = Random(3);
    let mut resolver = Resolver::new(Options::default());
    for _ in 0..100 {
        let couple = Couple::random(&mut random, 1.0, 1e-3);
        let [a, mut b] = couple.placed();
        let mut cache = Cache::default();
        resolver.resolve(&a, &b, &mut cache).unwrap();
        let programs = resolver.counts().programs;
        // A move that cannot close the gap. The plane's own gap may be a little less.
        b.centre += random.direction() * 1e-4;
        assert_eq!(
            resolver.resolve(&a, &b, &mut cache).unwrap(),
            Verdict::Apart
        );
        if cache.plane != [0.0; 3] {
            assert_eq!(resolver.counts().programs, programs);
        }
    }
    assert!(resolver.counts().planes > 80);
}
