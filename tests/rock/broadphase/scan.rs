//! The scan (exclusive prefix sum): each value becomes the sum of all values before it.

use kit::{Workbench, broadphase::Random};
use riprap::gpu::{bins::Scan, kernel::submit_pass, link::Program};

/// The same in integers that cannot overflow.
fn twin(values: &[u32]) -> (Vec<u32>, u32) {
    let mut sum = 0u64;
    let cut = |sum: u64| sum.min(u32::MAX.into()) as u32;
    let before = values.iter().map(|&value| {
        let before = cut(sum);
        sum += u64::from(value);
        before
    });
    let before = before.collect();
    (before, cut(sum))
}

fn numbers(count: usize, below: u32) -> Vec<u32> {
    let mut random = Random(count as u64);
    (0..count).map(|_| random.bits() % below).collect()
}

/// Scans of several sets of values one after the other, in one buffer.
fn scanned<const N: usize>(bench: &Workbench, rounds: [&[u32]; N]) -> [(Vec<u32>, u32); N] {
    let device = &bench.rig.device;
    let scan = Scan::new(device).unwrap();
    let buffer = bench.poisoned(rounds[0].len());
    let of = scan.of(device, &buffer).unwrap();
    rounds.map(|values| {
        let bytes = bytemuck::cast_slice(values);
        bench.rig.queue.write_buffer(&buffer, 0, bytes);
        submit_pass(device, &bench.rig.queue, |pass| scan.record(pass, &of));
        (bench.read(&buffer), bench.read::<u32>(of.total())[0])
    })
}

#[test]
fn adds_all_before() {
    let bench = Workbench::new(None);
    // One value; a run of 64 and its neighbours; 64 runs and their neighbours; 64³ values; a larger prime.
    for count in [1, 2, 63, 64, 65, 4095, 4096, 4097, 262_144, 300_007] {
        let values = numbers(count, 1000);
        assert!(
            scanned(&bench, [&values]) == [twin(&values)],
            "{count} values"
        );
    }
}

#[test]
fn sums_that_are_too_large_stay_at_the_largest() {
    let values = numbers(5003, u32::MAX / 100);
    let found = scanned(&Workbench::new(None), [&values]);
    assert_eq!(found[0].1, u32::MAX);
    assert!(found == [twin(&values)]);
}

#[test]
fn a_repeated_scan_starts_afresh() {
    let (first, second) = (numbers(777, 10), numbers(777, 11));
    let found = scanned(&Workbench::new(None), [&first, &second]);
    assert!(found == [twin(&first), twin(&second)]);
}

#[test]
fn kernels_of_the_scan_in_rows_of_workgroups() {
    for width in [None, Some(1), Some(3)] {
        let bench = Workbench::new(width);
        let values = numbers(64 * 64 * 5 + 17, 1000);
        let runs = values.len().div_ceil(64);
        let sums = bench.poisoned(runs);
        let buffers = [("values", &bench.buffer(&values)), ("run_sums", &sums)];
        bench.run(&Program::new("scan_sum"), "scan_sum", &[], &buffers, runs);
        let expected: Vec<u32> = values.chunks(64).map(|run| run.iter().sum()).collect();
        assert!(bench.read::<u32>(&sums) == expected, "{width:?}");

        let (starts, _) = twin(&expected);
        let scanned = bench.buffer(&values);
        let buffers = [
            ("scanned", &scanned),
            ("run_starts", &bench.buffer(&starts)),
        ];
        bench.run(
            &Program::new("scan_spread"),
            "scan_spread",
            &[],
            &buffers,
            runs,
        );
        assert!(bench.read::<u32>(&scanned) == twin(&values).0, "{width:?}");
    }
}
