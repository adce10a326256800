//! Contact or not, against parry's GJK and EPA, which share nothing with linear programs.

use super::{Outcome, Stand, Trial};
use kit::contact::{Couple, Random};
use riprap::rock::contact::{Cache, Options, Resolver, Verdict};
use std::time::Instant;

/// Gaps and overlaps from here on have a sign, in diameters of the smaller block.
const LEAST: f64 = 1e-9;
/// Largest ratio of the sizes of a pair.
const RATIO: f64 = 100.0;

/// 10⁴ random pairs of cubes, tetrahedra and hulls of 20 faces, ten times as many with `--full`.
///
/// parry knows a gap from afar, where its distance is well conditioned. It knows an overlap where its
/// depth is no more than what the blocks were moved by: below some 1e-8 its EPA at times returns
/// another face's depth.
pub fn sign(stand: &Stand) -> Outcome {
    let wanted = if stand.full { 100_000 } else { 10_000 };
    let mut random = Random(2018);
    let mut resolver = Resolver::new(Options::default());
    let (mut seen, mut wrong) = ([0u64; 2], 0u64);
    let mut seconds = 0.0;
    while seen[0] + seen[1] < wanted {
        let overlaps = random.below(2) == 0;
        let size = random.magnitude(LEAST, 0.05);
        let couple = Couple::random(&mut random, RATIO, if overlaps { -size } else { size });
        if overlaps {
            let depth = couple.oracle().map_or(0.0, |o| -o.dist / couple.length);
            if !(LEAST..1.001 * size).contains(&depth) {
                continue;
            }
        }
        let [a, b] = couple.placed();
        let begin = Instant::now();
        let verdict = resolver.resolve(&a, &b, &mut Cache::default())?;
        seconds += begin.elapsed().as_secs_f64();
        let right = match verdict {
            Verdict::Contact(_) => overlaps,
            Verdict::Apart => !overlaps,
            Verdict::Undecided => false,
        };
        wrong += u64::from(!right);
        seen[usize::from(overlaps)] += 1;
    }
    let trial = Trial {
        setup: format!("sizes up to 1:{RATIO}, gaps and overlaps from {LEAST:e} to 0.05"),
        cells: seen[0] + seen[1],
        steps: 1,
        seconds,
        ..Trial::default()
    };
    Ok(vec![
        trial.at_most("pairs that parry finds otherwise", wrong as f64, 0.0),
        trial.report("pairs in contact", seen[1] as f64, None),
        trial.report(
            "linear programs a pair, caches empty",
            resolver.counts().programs as f64 / trial.cells as f64,
            None,
        ),
    ])
}
