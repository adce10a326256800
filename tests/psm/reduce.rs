//! Loads on blocks, summed over the exchange with the fluid in each cell.

use crate::{
    combine_solids::{Moving, crowd, random_effective, random_shares},
    tiling::{Tiling, centre, grid},
};
use glam::DVec3;
use kit::{POISON, Random, Workbench};
use riprap::psm::{
    CellMapping, FACING_SUM, JOINT_SUM, PLANES, SHARED_SUM, WRENCH, constants, reduce_blocks,
    reduce_tiles,
};

const BLOCKS: u32 = 9;

/// Blocks in a grid, and a state of the fluid as after a step.
struct Case {
    tiling: Tiling,
    moving: Vec<Moving>,
    shares: Vec<f32>,
    effective: Vec<[f32; 2]>,
    saturation: Vec<f32>,
}

impl Case {
    /// Blocks 3 and 8 (the last one) have no tiles.
    fn new(seed: u64, lanes: u32, brick: [u32; 3]) -> Self {
        let mut noise = Random(seed);
        let middle = DVec3::new(17.0, -30.0, 13.0);
        let mut placed = crowd(&mut noise, BLOCKS - 1, middle);
        placed.retain(|part| part.block != 3);
        let mut tiling = Tiling::new(grid([21, 19, 22], lanes, brick), [7, -40, 3], placed);
        tiling.shorten(&mut noise);
        let moving = (0..BLOCKS).map(|_| Moving::new(middle, &mut noise));
        let moving: Vec<_> = moving.collect();
        let shares = random_shares(&tiling, &mut noise);
        let effective = random_effective(&shares, &mut noise);
        let size = tiling.workgroup() * PLANES * lanes as usize;
        let mut saturation = vec![f32::from_bits(POISON); tiling.slots as usize * size];
        // Cells without solid stay poisoned.
        for (number, tile) in tiling.tiles.iter().enumerate() {
            for local in 0..tiling.workgroup() {
                if effective[number * tiling.workgroup() + local][0] <= 0.0 {
                    continue;
                }
                let at = |plane| tiling.scalar(tile, plane, local);
                if saturation[at(4)].to_bits() == POISON {
                    // Deep cells and walls have no beta.
                    let fluid = noise.unit() > 0.3;
                    let joint = noise.unit() > 0.7;
                    // Half of the joints are only half closed.
                    let sum = if noise.unit() > 0.5 { 1.0 } else { 0.951 };
                    let shared = if noise.unit() > 0.5 { SHARED_SUM } else { 0.0 };
                    let closed = if noise.unit() > 0.5 {
                        JOINT_SUM
                    } else {
                        FACING_SUM
                    };
                    saturation[at(0)] = sum + if joint { closed } else { shared };
                    // Elsewhere the mean velocity must not be used.
                    for plane in 1..4 {
                        let any = 0.1 * noise.unit() as f32;
                        saturation[at(plane)] = if joint { any } else { f32::NAN };
                    }
                    for plane in 4..PLANES - 1 {
                        let scale = if plane > 4 { 1e-3 } else { 1.0 };
                        let any = scale * noise.unit() as f32;
                        saturation[at(plane)] = if fluid { any } else { 0.0 };
                    }
                }
            }
        }
        Self {
            tiling,
            moving,
            shares,
            effective,
            saturation,
        }
    }

    /// Expected loads of each block, and the sum of the absolute values of their terms.
    fn twin(&self) -> Vec<[(f64, f64); WRENCH]> {
        let tiling = &self.tiling;
        let mut all = vec![[(0.0, 0.0); WRENCH]; BLOCKS as usize];
        for (number, tile) in tiling.tiles.iter().enumerate() {
            let moving = &self.moving[tile.block as usize];
            for local in 0..tiling.workgroup() {
                let at = number * tiling.workgroup() + local;
                let (share, e) = (self.shares[at], f64::from(self.effective[at][0]));
                if e <= 0.0 || !tiling.reach(tile).contains(&local) {
                    continue;
                }
                let solid = f64::from(share.clamp(0.0, 1.0));
                let point = centre(tiling.cell(tile, local).unwrap());
                let r = (point - moving.centre).to_array();
                let at = |plane| f64::from(self.saturation[tiling.scalar(tile, plane, local)]);
                let own = moving.at(point);
                let mean = DVec3::new(at(1), at(2), at(3));
                // Both codes of a joint are below the code of an open shared cell.
                let u = match at(0) - f64::from(JOINT_SUM) {
                    sum if (0.0..16.0).contains(&sum) => {
                        own.lerp(mean, ((sum % 8.0 - 0.9) / 0.098).clamp(0.0, 1.0))
                    }
                    _ => own,
                };
                let u = u.to_array();
                let (beta, a) = (at(4), at(5));
                let held = e * beta;
                let freed = if beta > 0.0 { solid - held } else { 0.0 };
                let mut add = |k: usize, value: f64| {
                    all[tile.block as usize][k].0 += value;
                    all[tile.block as usize][k].1 += value.abs();
                };
                for i in 0..3 {
                    let f = -e * (a * u[i] + at(6 + i));
                    add(i, f);
                    for j in 0..3 {
                        add(3 + 3 * i + j, f * r[j]);
                    }
                    add(14 + i, held * r[i]);
                    add(17 + i, freed * r[i]);
                }
                add(12, held);
                add(13, freed);
            }
        }
        all
    }

    /// Tiles of each block in segments of at most `most`, and the number of segments before each block, and of all.
    fn segments(&self, most: usize) -> (Vec<u32>, Vec<u32>) {
        let (mut segments, mut block_first) = (Vec::new(), vec![0]);
        for ends in self.tiling.by_block(BLOCKS).windows(2) {
            let mut first = ends[0];
            while first < ends[1] {
                let count = (ends[1] - first).min(most as u32);
                segments.push(first + (1 << 28) * (count - 1));
                first += count;
            }
            block_first.push(segments.len() as u32);
        }
        (segments, block_first)
    }

    /// Wrenches computed by the kernels.
    fn run(&self, width: Option<u32>, walk: CellMapping, most: usize) -> Vec<f32> {
        let bench = Workbench::new(width);
        let motions: Vec<_> = self.moving.iter().map(Moving::on_device).collect();
        let (mut segments, block_first) = self.segments(most);
        let count = segments.len();
        segments.extend([u32::MAX; 3]);
        let partials = bench.poisoned(WRENCH * (count + 3));
        let wrenches = bench.poisoned(WRENCH * (BLOCKS as usize + 1));
        // The list is followed by tiles of an earlier, longer one.
        let mut listed = self.tiling.tiles.clone();
        listed.extend([self.tiling.tiles[0]; 3]);
        let buffers = [
            ("tiles", &bench.buffer(&listed)),
            ("motions", &bench.buffer(&motions)),
            ("solid_fractions", &bench.buffer(&self.shares)),
            ("effective_fractions", &bench.buffer(&self.effective)),
            ("psm_planes_0", &bench.buffer(&self.saturation)),
            ("block_first", &bench.buffer(&block_first)),
            ("segments", &bench.buffer(&segments)),
            ("partials", &partials),
            ("wrenches", &wrenches),
        ];
        let groups = walk.groups(count as u32 + 3) as usize;
        let program = reduce_tiles(&self.tiling.grid, walk);
        let numbers = constants(&self.tiling.grid);
        bench.run(&program, "reduce_tiles", &numbers, &buffers, 64 * groups);
        let blocks = 64 * (BLOCKS as usize + 1);
        bench.run(&reduce_blocks(), "reduce_blocks", &[], &buffers, blocks);
        let poison = |numbers: &[f32]| numbers.iter().all(|x| x.to_bits() == POISON);
        let partials: Vec<f32> = bench.read(&partials);
        assert!(
            poison(&partials[WRENCH * count..]),
            "segments behind the last"
        );
        let mut found: Vec<f32> = bench.read(&wrenches);
        let behind = found.split_off(WRENCH * BLOCKS as usize);
        assert!(poison(&behind), "a block behind the last");
        found
    }
}

#[test]
fn loads_are_sums_over_cells() {
    let cases = [
        (1, [4, 4, 4], None),
        (2, [5, 3, 7], Some(3)),
        (4, [4, 8, 8], Some(5)),
        (1, [4, 4, 2], None),
    ];
    let mut most_tiles = 0;
    for (seed, (lanes, brick, width)) in (20..).zip(cases) {
        let case = Case::new(seed, lanes, brick);
        let expected = case.twin();
        let first = case.tiling.by_block(BLOCKS);
        most_tiles = most_tiles.max(first.windows(2).map(|w| w[1] - w[0]).max().unwrap());
        for (walk, most) in [
            (CellMapping::Serial, 1),
            (CellMapping::Parallel, 1),
            (CellMapping::Parallel, 3),
            (CellMapping::Parallel, 16),
        ] {
            let found = case.run(width, walk, most);
            for (block, (found, expected)) in found.chunks(WRENCH).zip(&expected).enumerate() {
                for (k, (found, (value, size))) in found.iter().zip(expected).enumerate() {
                    // Sums of some thousand terms in f32; arms are exact to 1e-6 of a cell.
                    let most = 2e-6 * size;
                    let error = (f64::from(*found) - value).abs();
                    assert!(
                        error <= most,
                        "{walk:?}, block {block}, {k}: {found} {value}"
                    );
                }
                assert_eq!(expected[13].1 == 0.0, [3, 8].contains(&block));
            }
            let again = case.run(None, walk, most);
            assert!(again == found, "the same bits in any dispatch");
        }
    }
    assert!(
        most_tiles > 128,
        "invocations of reduce_blocks add several tiles"
    );
}
