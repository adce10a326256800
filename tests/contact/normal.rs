//! The contact normal.

use crate::{
    pairs::Couple,
    rig::{Random, Solid},
};
use clarabel::{
    algebra::CscMatrix,
    solver::{DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT},
};
use glam::{DQuat, DVec3};
use riprap::contact::{Cache, Contact, Normal, Options, Placed, Resolver, Verdict};

/// Normal of the linear program's dual, Σ z a over the first block.
fn dual_normal(a: &Placed, b: &Placed, length: f64) -> DVec3 {
    let (mut columns, mut bounds) = (vec![Vec::new(); 4], Vec::new());
    for block in [a, b] {
        for face in &block.faces {
            let n = face.normal;
            for (column, entry) in columns.iter_mut().zip([n.x, n.y, n.z, -1.0]) {
                column.push(entry);
            }
            bounds.push((face.distance + n.dot(block.centre - a.centre)) / length);
        }
    }
    let count = bounds.len();
    let matrix = CscMatrix::new(
        count,
        4,
        (0..=4).map(|c| c * count).collect(),
        (0..4 * count).map(|k| k % count).collect(),
        columns.concat(),
    );
    let settings = DefaultSettings {
        verbose: false,
        tol_gap_abs: 1e-12,
        tol_gap_rel: 1e-12,
        tol_feas: 1e-12,
        ..DefaultSettings::default()
    };
    let mut solver = DefaultSolver::new(
        &CscMatrix::zeros((4, 4)),
        &[0.0, 0.0, 0.0, 1.0],
        &matrix,
        &bounds,
        &[NonnegativeConeT(count)],
        settings,
    )
    .unwrap();
    solver.solve();
    let own = a.faces.iter().zip(&solver.solution.z);
    own.map(|(face, z)| face.normal * *z)
        .sum::<DVec3>()
        .normalize()
}

fn contact(resolver: &mut Resolver, a: &Placed, b: &Placed) -> Option<Contact> {
    match resolver.resolve(a, b, &mut Cache::default()).unwrap() {
        Verdict::Contact(contact) => Some(contact),
        _ => None,
    }
}

/// Angles (degrees) to the dual normal at an overlap in L, in order.
fn angles(overlap: f64) -> Vec<f64> {
    let mut random = Random(5);
    let mut resolver = Resolver::new(Options::default());
    let mut angles = Vec::new();
    for _ in 0..600 {
        let couple = Couple::random(&mut random, 1.0, -overlap);
        let [a, b] = couple.placed();
        let Some(found) = contact(&mut resolver, &a, &b) else {
            continue;
        };
        let dual = dual_normal(&a, &b, couple.length);
        angles.push(
            found
                .normal
                .cross(dual)
                .length()
                .min(1.0)
                .asin()
                .to_degrees(),
        );
    }
    angles.sort_by(f64::total_cmp);
    angles
}

/// Rows far from the overlap turn the barrier's normal by a share of overlap over the extent of the
/// contact. Random polyhedra include contacts about to change from face to edge, hence the tail.
#[test]
fn tends_to_the_dual_normal_with_the_overlap() {
    let quantiles = |overlap| {
        let angles = angles(overlap);
        assert_eq!(angles.len(), 600);
        [50, 90, 99].map(|percent| angles[angles.len() * percent / 100])
    };
    let (thick, thin) = (quantiles(1e-4), quantiles(1e-6));
    // Measured: 0.023°, 0.17° and 1.6° at 1e-4 L.
    assert!(
        thick[0] < 0.04 && thick[1] < 0.3 && thick[2] < 3.0,
        "{thick:?}"
    );
    for (thick, thin) in thick.into_iter().zip(thin) {
        let ratio = thick / thin;
        assert!(
            (40.0..250.0).contains(&ratio),
            "{thick}° to {thin}° in a hundredth of the overlap"
        );
    }
}

#[test]
fn swapping_the_blocks_turns_the_normal_and_keeps_every_bit() {
    let mut random = Random(6);
    for normal in [Normal::Barrier, Normal::Potential] {
        let mut resolver = Resolver::new(Options { normal });
        let mut contacts = 0;
        for round in 0..300 {
            let overlap = random.magnitude(1e-6, 0.03);
            let ratio = if round % 2 == 0 { 1.0 } else { 10.0 };
            let mut couple = Couple::random(&mut random, ratio, -overlap);
            if round % 4 == 0 {
                couple.solids[1] = couple.solids[0].clone();
            }
            let (mut cache, mut other) = (Cache::default(), Cache::default());
            // The caches take part: five steps of a small motion.
            for _ in 0..5 {
                couple.centres[1] += random.vector() * 1e-4 * overlap;
                let [a, b] = couple.placed();
                let there = resolver.resolve(&a, &b, &mut cache).unwrap();
                let back = resolver.resolve(&b, &a, &mut other).unwrap();
                let turned = match back {
                    Verdict::Contact(contact) => Verdict::Contact(Contact {
                        normal: -contact.normal,
                        ..contact
                    }),
                    verdict => verdict,
                };
                assert_eq!(there, turned);
                assert_eq!((cache.plane, cache.point), (other.plane, other.point));
                contacts += u32::from(matches!(there, Verdict::Contact(_)));
            }
        }
        assert!(contacts > 800, "{contacts}");
    }
}

/// Box on box, shifted so that the analytic centre is nowhere near the middle.
#[test]
fn flat_faces_give_their_own_normal() {
    let cube = Solid::cube();
    let mut resolver = Resolver::new(Options::default());
    let turn = Random(7).rotation();
    for shift in [
        DVec3::ZERO,
        DVec3::new(0.3, 0.1, 0.0),
        DVec3::new(0.9, -0.8, 0.0),
    ] {
        let a = cube.at(DVec3::ZERO, turn);
        let b = cube.at(turn * (shift + DVec3::Z * (1.0 - 1e-4)), turn);
        let found = contact(&mut resolver, &a, &b).unwrap();
        assert!(
            (found.normal - turn * DVec3::Z).length() < 1e-11,
            "{}",
            found.normal
        );
    }
}

/// At r = d_min/2 the potential particle's normal of a face contact would tilt by degrees.
#[test]
fn potential_normal_of_a_shifted_face_stays_upright() {
    let cube = Solid::cube();
    let mut resolver = Resolver::new(Options {
        normal: Normal::Potential,
    });
    let a = cube.at(DVec3::ZERO, DQuat::IDENTITY);
    let b = cube.at(DVec3::new(0.4, 0.2, 1.0 - 1e-4), DQuat::IDENTITY);
    let found = contact(&mut resolver, &a, &b).unwrap();
    assert!(found.normal.cross(DVec3::Z).length() < 1e-12);
}
