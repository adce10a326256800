//! Exact touch, deep overlap, numbers that are not finite.

use super::{contact, verdict};
use glam::{DQuat, DVec3};
use kit::{
    assert_near,
    contact::{Random, Solid, ball},
};
use riprap::rock::contact::{Cache, Options, Placed, Resolver, Verdict};

/// Faces, edges and corners that meet exactly, in any orientation: no force, and no panic.
#[test]
fn exact_touch_gives_no_force() {
    let cube = Solid::cube();
    let mut random = Random(14);
    let shifts = [
        DVec3::new(0.0, 0.0, 1.0),
        DVec3::new(0.3, -0.2, 1.0),
        DVec3::new(0.0, 1.0, 1.0),
        DVec3::new(0.4, 1.0, 1.0),
        DVec3::new(1.0, 1.0, 1.0),
    ];
    for round in 0..200 {
        let turn = if round < 5 {
            DQuat::IDENTITY
        } else {
            random.rotation()
        };
        let place = random.vector() * 10.0;
        let a = cube.at(place, turn);
        let b = cube.at(place + turn * shifts[round % 5], turn);
        let found = verdict(&a, &b);
        assert!(
            matches!(found, Verdict::Undecided | Verdict::Apart),
            "{:?}: {found:?}",
            shifts[round % 5]
        );
    }
}

/// A crossing of edges at exact touch, which no face separates.
#[test]
fn crossing_edges_that_touch_give_no_force() {
    let cube = Solid::cube();
    let half = 0.5f64.sqrt();
    let a = cube.at(
        -DVec3::Z * half,
        DQuat::from_rotation_x(std::f64::consts::FRAC_PI_4),
    );
    let b = cube.at(
        DVec3::Z * half,
        DQuat::from_rotation_y(std::f64::consts::FRAC_PI_4),
    );
    match verdict(&a, &b) {
        Verdict::Undecided | Verdict::Apart => {}
        Verdict::Contact(contact) => assert!(contact.overlap < 1e-14, "{contact:?}"),
    }
}

/// A contact that only touches for a step keeps its cache: the point is still there when it closes.
#[test]
fn touch_keeps_the_cache() {
    let cube = Solid::cube();
    let mut resolver = Resolver::new(Options::default());
    let mut cache = Cache::default();
    let a = cube.at(DVec3::ZERO, DQuat::IDENTITY);
    let mut at = |z: f64| {
        let b = cube.at(DVec3::Z * z, DQuat::IDENTITY);
        resolver.resolve(&a, &b, &mut cache).unwrap()
    };
    assert!(matches!(at(1.0 - 1e-4), Verdict::Contact(_)));
    assert_eq!(at(1.0), Verdict::Undecided);
    assert!(matches!(at(1.0 - 1e-4), Verdict::Contact(_)));
    assert!(cache.contact);
}

#[test]
fn deep_overlap_is_visible() {
    let cube = Solid::cube();
    let a = cube.at(DVec3::ZERO, DQuat::IDENTITY);
    for (u, deep) in [(0.049, false), (0.051, true), (0.3, true)] {
        let b = cube.at(DVec3::new(0.1, 0.05, 1.0 - u), DQuat::IDENTITY);
        let contact = contact(&a, &b);
        assert_eq!(contact.is_deep(), deep, "{u}");
        if u < 0.1 {
            assert_near(contact.overlap, u, 1e-12);
        }
    }
    // One block inside the other, and two blocks at the same position still give a contact.
    let small = Solid::cuboid(DVec3::splat(0.2)).at(DVec3::splat(0.1), DQuat::IDENTITY);
    for b in [small, a.clone()] {
        let contact = contact(&a, &b);
        assert!(contact.is_deep() && contact.point.is_finite());
    }
}

#[test]
fn a_pose_that_is_not_finite_is_an_error() {
    let cube = Solid::cube();
    let good = cube.at(DVec3::ZERO, DQuat::IDENTITY);
    let lost = cube.at(DVec3::new(0.0, f64::NAN, 0.9), DQuat::IDENTITY);
    let far = cube.at(DVec3::new(0.0, f64::INFINITY, 0.9), DQuat::IDENTITY);
    let no_size = ball(f64::NAN, DVec3::Z);
    let mut turned = Placed::default();
    let pose = riprap::geometry::Pose::at_rest(DVec3::Z, DQuat::from_xyzw(f64::NAN, 0.0, 0.0, 1.0));
    turned.update_sphere(0.4, DVec3::X, &pose);
    let mut resolver = Resolver::new(Options::default());
    for bad in [&lost, &far, &no_size, &turned] {
        for (a, b) in [(&good, bad), (bad, &good)] {
            let message = resolver
                .resolve(a, b, &mut Cache::default())
                .unwrap_err()
                .to_string();
            assert!(message.contains("not finite"), "{message}");
        }
    }
}

/// NaN in a single face or vertex: any verdict is accepted, but the resolver must return.
#[test]
fn a_broken_face_does_not_hang() {
    let cube = Solid::cube();
    let good = cube.at(DVec3::ZERO, DQuat::IDENTITY);
    let mut bad = cube.at(DVec3::Z * 0.99, DQuat::IDENTITY);
    bad.faces[2].normal.x = f64::NAN;
    let mut resolver = Resolver::new(Options::default());
    let _ = resolver.resolve(&good, &bad, &mut Cache::default());
    bad.vertices[1].x = f64::NAN;
    let _ = resolver.resolve(&good, &bad, &mut Cache::default());
}
