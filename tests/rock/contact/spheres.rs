//! Spheres, in closed form.

use super::{contact, verdict};
use glam::DVec3;
use kit::{
    assert_near,
    contact::{Random, Solid, ball},
};
use parry3d_f64::{math::Pose, query, shape::Ball};
use riprap::rock::contact::{ContactGeometry, Verdict};
use std::f64::consts::PI;

/// Radii 3 and 4, centres 5 apart: a right angle where the spheres meet, in a circle of radius 12/5
/// at 9/5 from the first centre.
#[test]
fn lens_of_two_spheres() {
    let turn = Random(15).direction();
    let from = DVec3::new(7.0, -3.0, 2.0);
    let found = contact(&ball(3.0, from), &ball(4.0, from + turn * 5.0));
    assert_near(found.area, PI * 5.76, 1e-12);
    assert_near(found.overlap, 2.0, 1e-13);
    assert!((found.point - from - turn * 1.8).length() < 1e-13);
    assert_near(found.width, 4.8, 1e-13);
    assert!((found.normal - turn).length() < 1e-15);
    assert!(found.is_deep());
}

#[test]
fn spheres_apart_and_touching() {
    let a = ball(1.0, DVec3::ZERO);
    assert_eq!(verdict(&a, &ball(0.5, DVec3::X * 1.5)), Verdict::Undecided);
    assert_eq!(
        verdict(&a, &ball(0.5, DVec3::X * (1.5 + 1e-9))),
        Verdict::Apart
    );
    assert_near(
        contact(&a, &ball(0.5, DVec3::X * (1.5 - 1e-9))).overlap,
        1e-9,
        1e-15,
    );
    // One sphere inside the other: finite, and deep.
    for centre in [DVec3::ZERO, DVec3::X * 0.1] {
        let inside = contact(&a, &ball(0.5, centre));
        assert!(inside.is_deep() && inside.point.is_finite() && inside.normal.is_normalized());
        assert_near(inside.area, PI * 0.25, 1e-12);
    }
}

/// On a face, an edge and a corner of a cube; areas of the sphere's own section.
#[test]
fn sphere_on_cube() {
    let (turn, u, r) = (Random(16).rotation(), 1e-3, 0.3);
    let cube = Solid::cube().at(DVec3::ONE, turn);
    let spots = [
        (DVec3::new(0.2, -0.1, 0.5), DVec3::Z),
        (DVec3::new(0.2, 0.5, 0.5), DVec3::new(0.0, 1.0, 2.0)),
        (DVec3::new(0.5, 0.5, 0.5), DVec3::new(1.0, 3.0, 2.0)),
    ];
    for (foot, way) in spots {
        let way = turn * way.normalize();
        let foot = DVec3::ONE + turn * foot;
        let sphere = ball(r, foot + way * (r - u));
        let found = contact(&cube, &sphere);
        assert!((found.normal - way).length() < 1e-12, "{}", found.normal);
        assert_near(found.overlap, u, 1e-14);
        assert_near(found.area, PI * u * (2.0 * r - u), 1e-13);
        assert!((found.point - foot).length() < 1e-13);
        assert_near(found.limit, 0.1 * r, 1e-16);
        // The other order: opposite normal, the same bits.
        let other = contact(&sphere, &cube);
        assert_eq!(
            ContactGeometry {
                normal: -other.normal,
                ..other
            },
            found
        );
        let gone = ball(r, foot + way * (r + 1e-9));
        assert_eq!(verdict(&cube, &gone), Verdict::Apart);
    }
}

/// The nearest point of random polyhedra against parry's, from inside and outside.
#[test]
fn sphere_and_polyhedron_agree_with_parry() {
    let mut random = Random(17);
    let mut seen = [0, 0];
    for _ in 0..3000 {
        let solid = Solid::any(&mut random);
        let (turn, radius) = (random.rotation(), random.magnitude(0.05, 5.0));
        let centre = random.direction() * random.between(0.6, 1.2) * (radius + 0.5);
        let (block, sphere) = (solid.at(DVec3::ZERO, turn), ball(radius, centre));
        let found = query::contact(
            &Pose::from_parts(DVec3::ZERO, turn),
            &solid.oracle,
            &Pose::from_translation(centre),
            &Ball::new(radius),
            1e6,
        );
        let oracle = found.unwrap().unwrap();
        if oracle.dist.abs() < 1e-9 {
            continue;
        }
        match verdict(&block, &sphere) {
            Verdict::Contact(contact) => {
                seen[0] += 1;
                assert!(
                    (contact.overlap + oracle.dist).abs() < 1e-7,
                    "{contact:?} {oracle:?}"
                );
                // Near-ties of faces decide the direction inside; outside there are none.
                if contact.overlap < radius - 1e-3 {
                    assert!((contact.normal - oracle.normal1).length() < 1e-6);
                    assert!((contact.point - oracle.point1).length() < 1e-6);
                }
            }
            verdict => {
                seen[1] += 1;
                assert_eq!(verdict, Verdict::Apart);
                assert!(oracle.dist > 0.0);
            }
        }
    }
    assert!(seen.iter().all(|n| *n > 500), "{seen:?}");
}
