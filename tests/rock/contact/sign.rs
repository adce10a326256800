//! Contact or not: against parry's GJK and EPA, which share nothing with linear programs.

use glam::DVec3;
use kit::contact::{Couple, Random, Solid};
use riprap::rock::contact::{Cache, Options, Resolver, Verdict};

/// Gaps and overlaps from here on have a sign, in L.
const LEAST: f64 = 1e-9;

const PAIRS: usize = 10_000;

/// A gap is known from parry's distance at a distance, where it is well conditioned; it is what the
/// blocks were moved together by. An overlap is known from parry's depth, where that lies between
/// [`LEAST`] and the depth to which the blocks were moved: below some 1e-8 L its EPA at times returns
/// another face's depth, or a depth where there is a gap.
#[test]
fn agrees_with_parry_from_gaps_of_1e_9() {
    let mut random = Random(1);
    let mut resolver = Resolver::new(Options::default());
    let (mut seen, mut wrong) = ([0, 0], Vec::new());
    while seen[0] + seen[1] < PAIRS {
        let overlaps = random.below(2) == 0;
        let size = random.magnitude(LEAST, 0.05);
        let gap = if overlaps { -size } else { size };
        let couple = Couple::random(&mut random, 100.0, gap);
        if overlaps {
            let depth = couple.oracle().map_or(0.0, |o| -o.dist / couple.length);
            if !(LEAST..1.001 * size).contains(&depth) {
                continue;
            }
        }
        let [a, b] = couple.placed();
        let verdict = resolver.resolve(&a, &b, &mut Cache::default()).unwrap();
        let right = match verdict {
            Verdict::Contact(_) => overlaps,
            Verdict::Apart => !overlaps,
            Verdict::Undecided => false,
        };
        if !right {
            wrong.push((gap, couple.length, verdict));
        }
        seen[usize::from(overlaps)] += 1;
    }
    assert!(wrong.is_empty(), "{} of {seen:?}: {wrong:?}", wrong.len());
    assert!(seen.iter().all(|n| *n > PAIRS / 3), "one-sided: {seen:?}");
}

/// Boxes with parallel edges, of sizes up to 1:30 and as flat as 1:20, whose sides, edges and corners
/// line up or not: an interval an axis says whether they overlap.
#[test]
fn agrees_with_intervals_for_aligned_boxes() {
    let mut random = Random(19);
    let mut resolver = Resolver::new(Options::default());
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
        let verdict = resolver.resolve(&a, &b, &mut Cache::default()).unwrap();
        let right = match verdict {
            Verdict::Contact(_) => least > 0.0,
            Verdict::Apart => least < 0.0,
            Verdict::Undecided => false,
        };
        assert!(right, "{first} {second} {shift}: {least} m, {verdict:?}");
        seen[usize::from(least > 0.0)] += 1;
    }
    assert!(seen.iter().all(|n| *n > 300), "one-sided: {seen:?}");
}
