//! The pairs of both broadphases against every pair tried, and how the host's cost grows.

use super::{Outcome, Stand, Trial};
use cpu_time::ProcessTime;
use riprap::rock::broadphase::{Aabb, Broadphase, DeviceBroadphase, HostBroadphase};

/// Boxes of sizes 1:100 in a cube, of which each meets a few others.
fn items(count: u32) -> Vec<Aabb> {
    let mut state = 0x9e37_79b9_7f4a_7c15u64 ^ u64::from(count);
    let mut random = move || {
        // Marsaglia 2003, xorshift64.
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    // Sizes 0.01 to 1 with equal numbers in each octave have a mean volume of 0.07 and meet each other
    // over some 0.6 volumes of 1: with a cube of N/4 each meets about one.
    let side = (0.25 * f64::from(count)).cbrt();
    let item = |group: u32| {
        let size = 100f64.powf(random() - 1.0);
        let min = [random(), random(), random()].map(|r| side * r);
        Aabb {
            min,
            max: min.map(|x| x + size),
            group,
        }
    };
    (0..count).map(item).collect()
}

fn every(items: &[Aabb]) -> Vec<[u32; 2]> {
    let n = items.len();
    let all = (0..n).flat_map(|i| (i + 1..n).map(move |j| [i, j]));
    let near = all.filter(|&[i, j]| items[i].overlaps(&items[j]));
    near.map(|pair| pair.map(|i| i as u32)).collect()
}

/// Pairs of either of two sorted lists that the other lacks.
fn differences(a: &[[u32; 2]], b: &[[u32; 2]]) -> f64 {
    let lacking = |a: &[[u32; 2]], b: &[[u32; 2]]| {
        let missing = a.iter().filter(|pair| b.binary_search(pair).is_err());
        missing.count()
    };
    (lacking(a, b) + lacking(b, a)) as f64
}

/// 10² to 10⁵ boxes; every pair is tried up to 10⁴, with `--full` up to 10⁵.
pub fn run(stand: &Stand) -> Outcome {
    let mut records = Vec::new();
    let mut costs = Vec::new();
    let mut on_device = DeviceBroadphase::new(&stand.device, &stand.queue)?;
    for exponent in 2..=5 {
        let count = 10u32.pow(exponent);
        let items = items(count);
        let mut finder = HostBroadphase;
        let mut found = Vec::new();
        let repeats = 10u32.pow(6 - exponent).min(1000);
        // The shortest of many: whatever else runs only adds.
        let mut seconds = f64::INFINITY;
        let mut total = 0.0;
        for _ in 0..repeats {
            let begin = ProcessTime::now();
            found = pollster::block_on(finder.pairs(&items))?;
            let took = begin.elapsed().as_secs_f64();
            seconds = seconds.min(took);
            total += took;
        }
        costs.push(seconds);
        let trial = Trial {
            setup: format!("{count} boxes, sizes 1:100"),
            cells: count.into(),
            steps: repeats.into(),
            seconds: total,
            ..Trial::default()
        };
        let pairs = found.len() as f64;
        records.push(trial.report("pairs a box", pairs / f64::from(count), None));
        records.push(trial.report("CPU time a list, s", seconds, None));
        let device = stand.drive("a search for pairs", on_device.pairs(&items))??;
        let differ = differences(&found, &device);
        records.push(trial.at_most("pairs that the device finds otherwise", differ, 0.0));
        if exponent <= 4 || stand.full {
            let off = differences(&found, &every(&items));
            records.push(trial.at_most("pairs that every pair tried finds otherwise", off, 0.0));
        }
        if exponent == 5 {
            // Told, not judged: what else runs on the machine must not fail a validation.
            // `riprap bench --only rock` judges it.
            let order = (costs[3] / costs[0]).log10() / 3.0;
            records.push(trial.report("exponent of the cost, 10² to 10⁵", order, Some(1.0)));
        }
    }
    Ok(records)
}
