//! Each kernel of the broadphase against the same formula in f64 and integers.

use kit::{
    POISON, Workbench,
    broadphase::{brute_force, scattered},
};
use riprap::{
    gpu::{
        bins::{DeviceBox, Level},
        layout::check,
        link::Program,
    },
    rock::broadphase::{Aabb, Boxes, Header, PairSearch},
    wgpu,
};
use std::{collections::BTreeMap, mem::offset_of};

/// The cell of a lower corner, from the edge length of a cell in m.
fn cell(corner: [f32; 3], level: &Level) -> [i64; 3] {
    let edge = 1.0 / f64::from(level.scale);
    corner.map(|x| (f64::from(x) / edge).floor() as i64)
}

fn bucket(cell: [i64; 3], level: u32, buckets: u64) -> u64 {
    let word = |x: i64| x.rem_euclid(1 << 32) as u64;
    let times = |a: u64, b: u64| (a * b) % (1 << 32);
    let block = cell.map(|x| x.div_euclid(4));
    let inside = cell.map(|x| x.rem_euclid(4) as u64);
    let primes = [73_856_093, 19_349_663, 83_492_791];
    let mut h = times(level.into(), 2_654_435_761);
    for (x, prime) in block.into_iter().zip(primes) {
        h ^= times(word(x), prime);
    }
    h = times(h ^ (h >> 16), 0x85eb_ca6b);
    h = times(h ^ (h >> 13), 0xc2b2_ae35);
    h ^= h >> 16;
    (64 * h + 16 * inside[2] + 4 * inside[1] + inside[0]) % buckets
}

/// Boxes, and the indices of those in each of the `buckets`.
struct Binned {
    boxes: Boxes,
    buckets: u64,
    of: BTreeMap<u64, Vec<u32>>,
}

impl Binned {
    fn new(items: &[Aabb]) -> Self {
        let boxes = Boxes::new(items).unwrap();
        let buckets = (2 * items.len() as u64).next_power_of_two();
        let mut of: BTreeMap<_, Vec<u32>> = BTreeMap::new();
        for (n, item) in (0..).zip(&boxes.boxes) {
            assert_eq!(item.number(), n);
            let cell = cell(item.min, &boxes.levels[item.level() as usize]);
            let bucket = bucket(cell, item.level(), buckets);
            of.entry(bucket).or_default().push(n);
        }
        Self { boxes, buckets, of }
    }

    fn starts(&self) -> Vec<u32> {
        let mut starts = vec![0];
        for bucket in 0..self.buckets {
            let size = self.of.get(&bucket).map_or(0, Vec::len) as u32;
            starts.push(starts[bucket as usize] + size);
        }
        starts
    }

    /// Lowest group with its bits inverted, and highest group.
    fn groups(&self) -> Vec<[u32; 2]> {
        let boxes = &self.boxes.boxes;
        let groups = (0..self.buckets).map(|bucket| {
            let Some(here) = self.of.get(&bucket) else {
                return [0, 0];
            };
            let groups = here.iter().map(|&n| boxes[n as usize].group);
            let low = groups.clone().min().unwrap();
            [u32::MAX - low, groups.max().unwrap()]
        });
        groups.collect()
    }

    fn entries(&self) -> Vec<DeviceBox> {
        let order = self.of.values().flatten();
        order.map(|&n| self.boxes.boxes[n as usize]).collect()
    }
}

#[test]
fn bin_count() {
    for width in [None, Some(3)] {
        let bench = Workbench::new(width);
        let binned = Binned::new(&scattered(997, 100.0, 1));
        let counts = bench.buffer(&vec![0u32; binned.buckets as usize + 1]);
        let groups = bench.buffer(&vec![[0u32; 2]; binned.buckets as usize]);
        let ranks = bench.poisoned(997);
        let buffers = [
            ("boxes", &bench.buffer(&binned.boxes.boxes)),
            ("levels", &bench.buffer(&binned.boxes.levels)),
            ("counts", &counts),
            ("ranks", &ranks),
            ("groups_in", &groups),
        ];
        bench.run(&Program::new("bin_count"), "bin_count", &[], &buffers, 997);
        let counts: Vec<u32> = bench.read(&counts);
        let ranks: Vec<u32> = bench.read(&ranks);
        for bucket in 0..binned.buckets {
            let here = binned.of.get(&bucket).map_or(&[][..], Vec::as_slice);
            assert_eq!(counts[bucket as usize] as usize, here.len());
            // Every rank once, in any order.
            let mut ranks: Vec<_> = here.iter().map(|&n| ranks[n as usize]).collect();
            ranks.sort_unstable();
            assert!(ranks.into_iter().eq(0..here.len() as u32), "{bucket}");
        }
        assert!(bench.read::<[u32; 2]>(&groups) == binned.groups());
        assert!(
            binned.of.values().any(|here| here.len() > 1),
            "ranks are tested"
        );
    }
}

#[test]
fn bin_scatter() {
    for width in [None, Some(3)] {
        let bench = Workbench::new(width);
        let binned = Binned::new(&scattered(997, 100.0, 1));
        let mut ranks = vec![0u32; 997];
        for here in binned.of.values() {
            for (rank, &n) in (0..).zip(here) {
                ranks[n as usize] = rank;
            }
        }
        let entries = bench.poisoned(8 * 997);
        let buffers = [
            ("boxes", &bench.buffer(&binned.boxes.boxes)),
            ("levels", &bench.buffer(&binned.boxes.levels)),
            ("starts", &bench.buffer(&binned.starts())),
            ("ranks", &bench.buffer(&ranks)),
            ("entries_out", &entries),
        ];
        let program = Program::new("bin_scatter");
        bench.run(&program, "bin_scatter", &[], &buffers, 997);
        assert!(bench.read::<DeviceBox>(&entries) == binned.entries());
    }
}

/// Slices of three candidates, so that most boxes need several, and a list in parts.
#[test]
fn pairs_are_counted_and_written_in_slices_and_parts() {
    let items = scattered(499, 100.0, 3);
    let expected = brute_force(&items);
    for (width, slice, part) in [(None, 8192, 100_000), (Some(7), 3, 97)] {
        let bench = Workbench::new(width);
        let binned = Binned::new(&items);
        let constants = [("SLICE", f64::from(slice))];
        let mut search = PairSearch {
            levels: binned.boxes.levels.len() as u32,
            slices: 1,
            first_pair: 0,
        };
        let shared = [
            ("entries", bench.buffer(&binned.entries())),
            ("starts", bench.buffer(&binned.starts())),
            ("groups_of", bench.buffer(&binned.groups())),
            ("levels", bench.buffer(&binned.boxes.levels)),
        ];
        let run = |found: &str, search: &PairSearch, own: [(&str, &wgpu::Buffer); 2]| {
            let search_buffer = bench.buffer(std::slice::from_ref(search));
            let mut buffers: Vec<_> = shared.iter().map(|(name, b)| (*name, b)).collect();
            buffers.push(("search", &search_buffer));
            buffers.extend(own);
            let program = Program::new("pairs").slot("found", found);
            let invocations = items.len() * search.slices as usize;
            bench.run(&program, "pairs", &constants, &buffers, invocations);
        };
        let mut counts = Vec::new();
        for _ in 0..2 {
            let header = bench.buffer(&[0u32, POISON]);
            let hits = bench.poisoned(items.len() * search.slices as usize);
            run(
                "found_count",
                &search,
                [("hits", &hits), ("header", &header)],
            );
            let header: Vec<Header> = bench.read(&header);
            counts = bench.read::<u32>(&hits);
            if header[0].candidates == 0 {
                break;
            }
            search.slices = header[0].candidates.div_ceil(slice);
        }
        assert!((slice == 3) == (search.slices > 1));
        let total: u32 = counts.iter().sum();
        let mut starts = vec![0];
        starts.extend(counts.iter().scan(0, |sum, count| {
            *sum += count;
            Some(*sum)
        }));
        let starts = bench.buffer(&starts);
        let mut found = Vec::new();
        while found.len() < total as usize {
            search.first_pair = found.len() as u32;
            let list = bench.poisoned(2 * part);
            run(
                "found_write",
                &search,
                [("pair_starts", &starts), ("pair_list", &list)],
            );
            let here = part.min(total as usize - found.len());
            let list: Vec<[u32; 2]> = bench.read(&list);
            found.extend(&list[..here]);
            // Nothing is written behind the last pair.
            assert!(list[here..].iter().all(|pair| *pair == [POISON; 2]));
        }
        // f32 boxes may touch where the exact ones just miss each other.
        found.sort_unstable();
        assert!(found.windows(2).all(|w| w[0] != w[1]), "a pair twice");
        assert!(
            expected
                .iter()
                .all(|pair| found.binary_search(pair).is_ok())
        );
        assert!(found.len() <= expected.len() + 1, "{} pairs", found.len());
    }
}

/// The structs of the host have the layout of the kernels.
#[test]
fn layouts() {
    let boxes = [
        ("min", offset_of!(DeviceBox, min)),
        ("group", offset_of!(DeviceBox, group)),
        ("max", offset_of!(DeviceBox, max)),
        ("tag", offset_of!(DeviceBox, tag)),
    ];
    for entry in ["bin_count", "bin_scatter"] {
        let linked = Program::new(entry).link().unwrap();
        check::<DeviceBox>(&linked.module, "Box", &boxes).unwrap();
    }
    let program = Program::new("pairs").slot("found", "found_count");
    let pairs = program.link().unwrap().module;
    check::<DeviceBox>(&pairs, "Box", &boxes).unwrap();
    let levels = [
        ("scale", offset_of!(Level, scale)),
        ("extent", offset_of!(Level, extent)),
    ];
    check::<Level>(&pairs, "Level", &levels).unwrap();
    let searches = [
        ("levels", offset_of!(PairSearch, levels)),
        ("slices", offset_of!(PairSearch, slices)),
        ("first_pair", offset_of!(PairSearch, first_pair)),
    ];
    check::<PairSearch>(&pairs, "PairSearch", &searches).unwrap();
    let headers = [
        ("candidates", offset_of!(Header, candidates)),
        ("pairs", offset_of!(Header, pairs)),
    ];
    check::<Header>(&pairs, "Header", &headers).unwrap();
}
