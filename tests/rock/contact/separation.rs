//! A pair that is apart keeps a plane that shows it.

use glam::DVec3;
use kit::contact::{Couple, Random};
use riprap::rock::contact::{Cache, Options, Resolver, Verdict};

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
        // No direction shows more than the distance.
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
