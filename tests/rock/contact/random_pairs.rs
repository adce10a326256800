//! Random pairs: contact or not, the contact point, and independence of position, rotation and unit of length.

use super::{contact, verdict};
use glam::{DMat3, DQuat, DVec3};
use kit::contact::{Couple, Random, Solid};
use riprap::rock::contact::{Cache, Options, Placed, Resolver, Verdict};

/// Boxes with parallel edges, of sizes up to 1:30 and as flat as 1:20, whose sides, edges and corners
/// line up or not: one interval per axis decides whether they overlap.
#[test]
fn agrees_with_intervals_for_aligned_boxes() {
    let mut random = Random(19);
    let mut seen = [0, 0];
    for _ in 0..3000 {
        let mut edges = || DVec3::from_array(std::array::from_fn(|_| random.magnitude(0.05, 1.0)));
        let (first, second) = (edges(), edges() * 1.5);
        let length = first.length().min(second.length());
        let mut least = f64::INFINITY;
        let shift = DVec3::from_array(std::array::from_fn(|axis| {
            let reach = 0.5 * (first[axis] + second[axis]);
            let flush = 0.5 * (first[axis] - second[axis]);
            let size = random.magnitude(1e-9, 0.01) * length;
            let shift = match random.below(5) {
                0 => 0.0,
                1 => flush,
                2 => random.between(-0.9, 0.9) * reach,
                3 => reach - size.min(0.5 * reach),
                _ => {
                    reach
                        + if random.below(2) == 0 {
                            size
                        } else {
                            -size.min(0.5 * reach)
                        }
                }
            };
            least = least.min(reach - shift.abs());
            shift
        }));
        let (place, turn) = (random.vector() * 3.0, random.rotation());
        let a = Solid::cuboid(first).at(place, turn);
        let b = Solid::cuboid(second).at(place + turn * shift, turn);
        let found = verdict(&a, &b);
        let right = match found {
            Verdict::Contact(_) => least > 0.0,
            Verdict::Apart => least < 0.0,
            Verdict::Undecided => false,
        };
        assert!(right, "{first} {second} {shift}: {least} m, {found:?}");
        seen[usize::from(least > 0.0)] += 1;
    }
    assert!(seen.iter().all(|n| *n > 300), "one-sided: {seen:?}");
}

/// Newton's decrement λ² of −Σ log(slack) at `x`, and the smallest slack, from the unscaled blocks.
fn decrement(blocks: [&Placed; 2], x: DVec3) -> (f64, f64) {
    let (mut gradient, mut hessian) = (DVec3::ZERO, DMat3::ZERO);
    let mut least = f64::INFINITY;
    for block in blocks {
        for face in &block.faces {
            let slack = face.distance - face.normal.dot(x - block.centre);
            let a = face.normal / slack;
            gradient += a;
            hessian += DMat3::from_cols(a * a.x, a * a.y, a * a.z);
            least = least.min(slack);
        }
    }
    (gradient.dot(hessian.inverse() * gradient), least)
}

#[test]
fn the_gradient_vanishes_and_both_blocks_hold_the_point() {
    let mut random = Random(4);
    let mut resolver = Resolver::new(Options::default());
    let mut contacts = 0;
    for _ in 0..1500 {
        let overlap = random.magnitude(1e-4, 0.05);
        let couple = Couple::random(&mut random, 1.0, -overlap);
        let [a, b] = couple.placed();
        let verdict = resolver.resolve(&a, &b, &mut Cache::default()).unwrap();
        let Verdict::Contact(contact) = verdict else {
            continue;
        };
        contacts += 1;
        let (square, least) = decrement([&a, &b], contact.point);
        assert!(least > 0.0, "outside by {least} m");
        // The last step leaves λ² below 1e-10; recomputed slacks of 1e-5 L are accurate to 1e-11.
        assert!(square < 1e-10, "λ² = {square} at an overlap of {overlap} L");
    }
    assert!(contacts > 1000);
    let steps = resolver.counts().newton_steps as f64 / contacts as f64;
    assert!(steps < 8.0, "{steps} steps a contact");
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
        let [a, b] = couple.placed();
        let here = contact(&a, &b);
        for scale in [1e-3, 1.0, 1e3] {
            let turn = random.rotation();
            let shift = random.vector() * 100.0 * scale;
            let [a, b] = moved(&couple, scale, turn, shift).placed();
            let there = contact(&a, &b);
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
    // Coordinates of 100 L cost 1e-14 L, a share of 1e-11 of the overlap; the quadratic last step leaves the
    // centre at λ of at most 1e-10.
    assert!(worst < 1e-8, "{worst}");
}
