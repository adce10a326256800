//! The point of contact is the analytic centre of the overlap.

use glam::{DMat3, DVec3};
use kit::contact::{Couple, Random};
use riprap::rock::contact::{Cache, Options, Placed, Resolver, Verdict};

/// Newton's decrement λ² of −Σ log(slack) at `x`, and the smallest slack, from the blocks as they are.
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
        // The last step leaves λ² below 1e-10; slacks of 1e-5 L formed anew are good to 1e-11.
        assert!(square < 1e-10, "λ² = {square} at an overlap of {overlap} L");
    }
    assert!(contacts > 1000);
    let steps = resolver.counts().newton_steps as f64 / contacts as f64;
    assert!(steps < 8.0, "{steps} steps a contact");
}
