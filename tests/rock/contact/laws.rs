//! Properties of contacts for hulls of random points, as flat as 1:20; proptest shrinks a failing pair.
//!
//! The oracle is the separating axis theorem: the separation of two convex polyhedra is the largest one along the
//! normals of their faces and the cross products of their edges.

use super::verdict;
use glam::{DQuat, DVec3};
use kit::contact::Solid;
use proptest::prelude::*;
use riprap::rock::contact::{Cache, Options, Placed, Resolver, Verdict};

/// A hull of points in a stretched cube.
fn hull() -> impl Strategy<Value = Solid> {
    let point = prop::array::uniform3(-1.0..1.0_f64).prop_map(DVec3::from_array);
    let stretch = prop::array::uniform3(-3.0..0.0_f64).prop_map(|s| DVec3::from_array(s).exp());
    (prop::collection::vec(point, 6..24), stretch).prop_filter_map("flat", |(points, stretch)| {
        let points: Vec<DVec3> = points.iter().map(|p| *p * stretch).collect();
        let mean = points.iter().sum::<DVec3>() / points.len() as f64;
        let spread = |axis: DVec3| {
            points
                .iter()
                .map(|p| axis.dot(*p - mean).abs())
                .sum::<f64>()
        };
        let axes = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE];
        if axes
            .iter()
            .any(|axis| spread(*axis) < 0.05 * points.len() as f64 * 0.1)
        {
            return None;
        }
        let solid = Solid::hull(&points.iter().map(|p| *p - mean).collect::<Vec<_>>());
        let flat = solid.faces.iter().any(|face| face.distance < 1e-2);
        (!flat && solid.has_plane_faces()).then_some(solid)
    })
}

fn rotation() -> impl Strategy<Value = DQuat> {
    prop::array::uniform4(-1.0..1.0_f64).prop_filter_map("no direction", |q| {
        let q = DQuat::from_array(q);
        (q.length_squared() > 0.01).then(|| q.normalize())
    })
}

/// A gap, or an overlap if negative, of any size from 1e-8.
fn gap() -> impl Strategy<Value = f64> {
    (-8.0..-1.5_f64, any::<bool>()).prop_map(|(size, apart)| {
        let size = 10f64.powf(size);
        if apart { size } else { -size }
    })
}

/// Cross products of all pairs of face normals, which include the directions of all edges.
fn edges(block: &Placed) -> Vec<DVec3> {
    let mut found: Vec<DVec3> = Vec::new();
    let faces = &block.faces;
    for (k, first) in faces.iter().enumerate() {
        for second in &faces[k + 1..] {
            let along = first.normal.cross(second.normal);
            if let Some(along) = along.try_normalize() {
                found.push(along);
            }
        }
    }
    found
}

/// Separation, negative if the blocks overlap, and its axis from the first to the second.
fn separation(first: &Placed, second: &Placed) -> (f64, DVec3) {
    let reach = |block: &Placed, n: DVec3| {
        let heights = block.vertices.iter().map(|v| n.dot(*v));
        heights.fold(f64::NEG_INFINITY, f64::max)
    };
    let way = second.centre - first.centre;
    let mut best = (f64::NEG_INFINITY, DVec3::ZERO);
    let mut look = |n: DVec3| {
        let apart = n.dot(way) - reach(first, n) - reach(second, -n);
        if apart > best.0 {
            best = (apart, n);
        }
    };
    first.faces.iter().for_each(|face| look(face.normal));
    second.faces.iter().for_each(|face| look(-face.normal));
    let others = edges(second);
    for a in edges(first) {
        for b in &others {
            if let Some(n) = a.cross(*b).try_normalize() {
                look(n);
                look(-n);
            }
        }
    }
    best
}

/// Moves the second block until the two are `gap` apart; `None` if that fails.
fn closed(first: &Placed, mut second: Placed, gap: f64) -> Option<Placed> {
    for _ in 0..40 {
        let (apart, n) = separation(first, &second);
        if (apart - gap).abs() < 1e-3 * gap.abs() {
            return Some(second);
        }
        second.centre -= n * (apart - gap);
    }
    None
}

fn cached(first: &Placed, second: &Placed, cache: &mut Cache) -> Verdict {
    let mut resolver = Resolver::new(Options::default());
    resolver.resolve(first, second, cache).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// Contact if and only if no axis separates, with a point inside both blocks. The same with the blocks in the
    /// other order, and with the cache of another position.
    #[test]
    fn contact_if_and_only_if_no_axis_separates(
        solids in (hull(), hull()),
        turns in (rotation(), rotation()),
        way in prop::array::uniform3(-1.0..1.0_f64),
        gap in gap(),
        step in prop::array::uniform3(-1.0..1.0_f64),
    ) {
        let first = solids.0.at(DVec3::ZERO, turns.0);
        let second = solids.1.at(DVec3::from_array(way) * 2.0, turns.1);
        let second = closed(&first, second, gap);
        prop_assume!(second.is_some());
        let second = second.unwrap();
        let mut cache = Cache::default();
        let found = cached(&first, &second, &mut cache);
        prop_assert_eq!(matches!(found, Verdict::Contact(_)), gap < 0.0, "{:?} at {}", found, gap);
        prop_assert!(found != Verdict::Undecided);

        let other = verdict(&second, &first);
        match (found, other) {
            (Verdict::Contact(a), Verdict::Contact(b)) => {
                for block in [&first, &second] {
                    let inside = block.faces.iter().all(|f| f.height(a.point - block.centre) < 0.0);
                    prop_assert!(inside, "{:?} is not in both", a);
                }
                let near = (a.point - b.point).length() < 1e-6 && a.normal.dot(b.normal) < -0.999;
                prop_assert!(near, "{:?}, and in the other order {:?}", a, b);
            }
            (a, b) => prop_assert_eq!(a, b),
        }

        // At a nearby position, with and without a cache.
        let mut near = second.clone();
        near.centre += DVec3::from_array(step) * 3.0 * gap.abs();
        let (apart, _) = separation(&first, &near);
        prop_assume!(apart.abs() > 1e-9);
        let remembers = cached(&first, &near, &mut cache);
        let fresh = verdict(&first, &near);
        let kind = |v: Verdict| matches!(v, Verdict::Contact(_));
        prop_assert_eq!(kind(remembers), apart < 0.0, "{} at {}", gap, apart);
        prop_assert_eq!(kind(fresh), apart < 0.0, "{} at {}", gap, apart);
    }
}
