//! Blocks cut from one rock mass: neighbours' faces coincide.

use glam::{DQuat, DVec3};
use riprap::{
    geometry::{HalfSpace, JointSet, Pose, RockMass, Scatter},
    rock::contact::{Cache, Options, Placed, Resolver, Verdict},
};

/// A box of 12 m, far from the origin, cut by three oblique joint sets.
fn blocks() -> Vec<Placed> {
    let at = DVec3::new(400.0, -300.0, 200.0);
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let sides = axes.iter().flat_map(|axis| [*axis, -*axis]);
    let volume = sides.map(|normal| HalfSpace {
        normal,
        distance: normal.dot(at) + 6.0,
    });
    let joint = |dip, dip_direction, seed| JointSet {
        dip,
        dip_direction,
        spacing: 2.0,
        scatter: Scatter::Lognormal { deviation: 0.8 },
        origin: at,
        seed,
        persistence: None,
    };
    let mass = RockMass {
        joints: vec![
            joint(35.0, 80.0, 1),
            joint(80.0, 170.0, 2),
            joint(65.0, 265.0, 3),
        ],
        ..RockMass::new(vec![volume.collect()])
    };
    let fragments = mass.cut().unwrap();
    let placed = fragments.blocks.iter().map(|block| {
        let pose = Pose::at_rest(block.centre, DQuat::IDENTITY);
        let mut placed = Placed::default();
        placed.update(&block.shape, DVec3::ZERO, &pose);
        placed
    });
    placed.collect()
}

/// No force before any motion, and no linear program: the common face is proof.
#[test]
fn coinciding_faces_touch() {
    let blocks = blocks();
    assert!(blocks.len() > 200, "{}", blocks.len());
    let mut resolver = Resolver::new(Options::default());
    let mut caches = Vec::new();
    let (mut touching, mut deepest): (usize, f64) = (0, 0.0);
    let mut pass = |caches: &mut Vec<Cache>, resolver: &mut Resolver| {
        let mut k = 0;
        for (i, a) in blocks.iter().enumerate() {
            for b in &blocks[..i] {
                if a.centre.distance(b.centre) > a.radius + b.radius {
                    continue;
                }
                if k == caches.len() {
                    caches.push(Cache::default());
                }
                match resolver.resolve(a, b, &mut caches[k]).unwrap() {
                    Verdict::Contact(contact) => deepest = deepest.max(contact.overlap),
                    Verdict::Undecided => touching += 1,
                    Verdict::Apart => {}
                }
                k += 1;
            }
        }
    };
    pass(&mut caches, &mut resolver);
    let first = resolver.counts();
    pass(&mut caches, &mut resolver);
    let counts = resolver.counts();
    assert_eq!(deepest, 0.0);
    assert!(touching > 2 * 4000, "{touching}");
    assert_eq!((first.programs, first.guesses), (0, first.pairs));
    // Nothing moved: each cached plane is still valid.
    assert_eq!((counts.programs, counts.planes), (0, first.pairs));
}
