//! Contact or not: against parry's GJK and EPA, which share nothing with linear programs.

use crate::{pairs::Couple, rig::Random};
use riprap::contact::{Cache, Options, Resolver, Verdict};

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
            Verdict::Touching => false,
        };
        if !right {
            wrong.push((gap, couple.length, verdict));
        }
        seen[usize::from(overlaps)] += 1;
    }
    assert!(wrong.is_empty(), "{} of {seen:?}: {wrong:?}", wrong.len());
    assert!(seen.iter().all(|n| *n > PAIRS / 3), "one-sided: {seen:?}");
}
