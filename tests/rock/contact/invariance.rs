//! Where a pair is, how it is turned, and in which unit it is measured does not matter.

use glam::{DQuat, DVec3};
use kit::contact::{Couple, Random};
use riprap::rock::contact::{Cache, ContactGeometry, Options, Resolver, Verdict};

fn contact(couple: &Couple) -> ContactGeometry {
    let [a, b] = couple.placed();
    let mut resolver = Resolver::new(Options::default());
    match resolver.resolve(&a, &b, &mut Cache::default()).unwrap() {
        Verdict::Contact(contact) => contact,
        other => panic!("{other:?}"),
    }
}

fn moved(couple: &Couple, scale: f64, turn: DQuat, shift: DVec3) -> Couple {
    Couple {
        solids: [0, 1].map(|k| couple.solids[k].scaled(scale)),
        centres: couple.centres.map(|c| turn * (c * scale) + shift),
        rotations: couple.rotations.map(|r| (turn * r).normalize()),
        length: couple.length * scale,
    }
}

#[test]
fn contact_is_the_same_anywhere_and_at_any_size() {
    let mut random = Random(10);
    let mut worst: f64 = 0.0;
    for _ in 0..150 {
        let couple = Couple::random(&mut random, 3.0, -1e-3);
        let here = contact(&couple);
        for scale in [1e-3, 1.0, 1e3] {
            let turn = random.rotation();
            let shift = random.vector() * 100.0 * scale;
            let there = contact(&moved(&couple, scale, turn, shift));
            let place = |p: DVec3| turn * (p * scale) + shift;
            let length = couple.length * scale;
            for error in [
                (there.point - place(here.point)).length() / length,
                (there.pressure_centre - place(here.pressure_centre)).length() / length,
                (there.normal - turn * here.normal).length(),
                (there.overlap / (here.overlap * scale) - 1.0).abs(),
                (there.area / (here.area * scale * scale) - 1.0).abs(),
                (there.width / (here.width * scale) - 1.0).abs(),
            ] {
                worst = worst.max(error);
            }
        }
    }
    // Coordinates of 100 L cost 1e-14 L, a share of 1e-11 of the overlap; the centre is left at λ of
    // at most 1e-10 by its quadratic last step.
    assert!(worst < 1e-8, "{worst}");
}
