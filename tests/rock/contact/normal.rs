//! The contact normal.

use super::contact;
use clarabel::{
    algebra::CscMatrix,
    solver::{DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT},
};
use glam::{DQuat, DVec3};
use kit::contact::{Couple, Random, Solid};
use riprap::rock::contact::{Cache, ContactGeometry, Normal, Options, Placed, Resolver, Verdict};

/// Multipliers of the linear program, those of the first block first, and the normal Σ z a over the first block.
fn dual(a: &Placed, b: &Placed, length: f64) -> (Vec<f64>, DVec3) {
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
    let multipliers = solver.solution.z;
    let own = a.faces.iter().zip(&multipliers);
    let normal = own.map(|(face, z)| face.normal * *z).sum::<DVec3>();
    (multipliers, normal.normalize())
}

/// Angle (rad) between the contact normal and the dual one, and the weight of the faces that the program
/// leaves out: Σ 1/t over these faces, divided by |Σ a/t| over the first block.
struct Tilt {
    angle: f64,
    left_out: f64,
}

/// Tilts at an overlap in L.
fn tilts(overlap: f64) -> Vec<Tilt> {
    let mut random = Random(5);
    let tilt = |_| {
        let couple = Couple::random(&mut random, 1.0, -overlap);
        let [a, b] = couple.placed();
        let found = contact(&a, &b);
        let (multipliers, normal) = dual(&a, &b, couple.length);
        let slack = |block: &Placed, k: usize| {
            let face = block.faces[k];
            face.distance - face.normal.dot(found.point - block.centre)
        };
        let own = (0..a.faces.len()).map(|k| (slack(&a, k), a.faces[k].normal));
        let whole: DVec3 = own.map(|(t, n)| n / t).sum();
        let slacks = [&a, &b].into_iter().flat_map(|block| {
            let all = 0..block.faces.len();
            all.map(move |k| slack(block, k))
        });
        let out = slacks.zip(&multipliers).filter(|(_, z)| **z < 1e-6);
        Tilt {
            angle: found.normal.cross(normal).length().min(1.0).asin(),
            left_out: out.map(|(t, _)| 1.0 / t).sum::<f64>() / whole.length(),
        }
    };
    (0..600).map(tilt).collect()
}

/// Quantiles at 50, 90 and 99 %.
fn quantiles(values: impl Iterator<Item = f64>) -> [f64; 3] {
    let mut sorted: Vec<_> = values.collect();
    sorted.sort_by(f64::total_cmp);
    [50, 90, 99].map(|percent| sorted[sorted.len() * percent / 100])
}

/// Faces far from the overlap tilt the barrier's normal in proportion to the overlap over the extent of the
/// contact. Random polyhedra include contacts about to change from face to edge, hence the tail.
#[test]
fn tends_to_the_dual_normal_with_the_overlap() {
    let angles = |overlap| quantiles(tilts(overlap).iter().map(|tilt| tilt.angle.to_degrees()));
    let (thick, thin) = (angles(1e-4), angles(1e-6));
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

/// The tilt from the dual normal comes entirely from the faces that the program leaves out and the
/// barrier includes, such as those at a nearby edge that does not take part in the contact yet. The tail is
/// therefore the same for thick and thin overlaps, in units of the weight of these faces.
#[test]
fn the_tilt_from_the_dual_normal_is_the_weight_of_the_faces_left_out() {
    for overlap in [1e-3, 1e-4, 1e-6] {
        let tilts = tilts(overlap);
        let shares = quantiles(tilts.iter().map(|tilt| tilt.angle / tilt.left_out));
        // Measured at each overlap: 0.19, 0.61 and 0.99; more than one if the faces that take part are
        // nearly parallel.
        assert!(
            shares[0] < 0.25 && shares[1] < 0.75 && shares[2] < 1.25,
            "{overlap}: {shares:?}"
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
            // Five steps of a small motion, with caches.
            for _ in 0..5 {
                couple.centres[1] += random.vector() * 1e-4 * overlap;
                let [a, b] = couple.placed();
                let there = resolver.resolve(&a, &b, &mut cache).unwrap();
                let back = resolver.resolve(&b, &a, &mut other).unwrap();
                let turned = match back {
                    Verdict::Contact(contact) => Verdict::Contact(ContactGeometry {
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

/// Box on box, shifted so that the analytic centre is far from the middle.
#[test]
fn flat_faces_give_their_own_normal() {
    let cube = Solid::cube();
    let turn = Random(7).rotation();
    for shift in [
        DVec3::ZERO,
        DVec3::new(0.3, 0.1, 0.0),
        DVec3::new(0.9, -0.8, 0.0),
    ] {
        let a = cube.at(DVec3::ZERO, turn);
        let b = cube.at(turn * (shift + DVec3::Z * (1.0 - 1e-4)), turn);
        let found = contact(&a, &b);
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
    let found = resolver.resolve(&a, &b, &mut Cache::default()).unwrap();
    let Verdict::Contact(found) = found else {
        panic!("{found:?}");
    };
    assert!(found.normal.cross(DVec3::Z).length() < 1e-12);
}
