//! Combination of all parts in each cell.

use crate::{
    effective::together,
    tiling::{Placed, Tiling, centre, grid, split},
};
use glam::{DMat3, DVec3};
use kit::{POISON, Random, Workbench, assert_near};
use riprap::psm::{
    CellMapping, FACING_SUM, INTERIOR, INTERIOR_SUM, JOINT_SUM, Motion, NEAR, PLANES, SHARED_SUM,
    TOUCHES, Tile, WHOLE, combine_parts, constants,
};
use std::collections::BTreeSet;

/// Motion of a block, in f64.
pub struct Moving {
    pub centre: DVec3,
    pub velocity: DVec3,
    pub gradient: DMat3,
}

impl Moving {
    pub fn new(near: DVec3, noise: &mut Random) -> Self {
        let mut vector = || noise.point() - 0.5;
        Self {
            centre: near + vector(),
            velocity: 0.1 * vector(),
            gradient: DMat3::from_cols(vector(), vector(), vector()) * 0.01,
        }
    }

    pub fn on_device(&self) -> Motion {
        let (base, fraction) = split(self.centre);
        let [x, y, z] = [0, 1, 2].map(|a| self.gradient.col(a).as_vec3().to_array());
        Motion {
            base,
            fraction,
            velocity: self.velocity.as_vec3().to_array(),
            gradient_x: x,
            gradient_y: y,
            gradient_z: z,
            // Padding that no kernel may use.
            pad0: POISON,
            pad1: POISON,
            pad2: POISON,
            pad3: POISON,
            pad4: POISON,
            pad5: POISON,
        }
    }

    pub fn at(&self, point: DVec3) -> DVec3 {
        self.velocity + self.gradient * (point - self.centre)
    }
}

/// Balls of several blocks, some with more than one, in a domain of about 20 cells around `middle`.
pub fn crowd(noise: &mut Random, blocks: u32, middle: DVec3) -> Vec<Placed> {
    let mut placed = Vec::new();
    for block in 0..blocks {
        for _ in 0..=block % 3 {
            let at = middle + (noise.point() - 0.5) * 10.0;
            placed.push(Placed::ball(block, 5.0 * noise.unit(), at));
        }
    }
    placed
}

/// Random marks and fractions.
pub fn random_shares(tiling: &Tiling, noise: &mut Random) -> Vec<f32> {
    let mut shares = Vec::new();
    for tile in &tiling.tiles {
        shares.extend((0..tiling.workgroup()).map(|local| {
            let any = noise.unit();
            match (tiling.cell(tile, local), (9.0 * any) as u32) {
                (None, _) | (_, 0..3) => 0.0,
                (_, 8) => TOUCHES,
                (_, 3) => NEAR,
                (_, 4) => INTERIOR,
                (_, 5) => 1.0,
                _ => noise.unit() as f32,
            }
        }));
    }
    shares
}

/// Random effective fractions for cells with a share or a mark.
pub fn random_effective(shares: &[f32], noise: &mut Random) -> Vec<[f32; 2]> {
    let one = |share: &f32| match *share {
        INTERIOR | 1.0 => [1.0; 2],
        share if share > 0.0 || (share == NEAR && noise.unit() > 0.5) => {
            let alone = noise.unit() as f32;
            [alone, alone * (0.5 + 0.5 * noise.unit() as f32)]
        }
        _ => [0.0; 2],
    };
    shares.iter().map(one).collect()
}

/// Sum of the effective fractions with its code, velocity, and solid fraction of one cell of a slot.
fn twin(
    tiling: &Tiling,
    (shares, effective): (&[f32], &[[f32; 2]]),
    moving: &[Moving],
    at: [u32; 3],
) -> (f64, DVec3, f64) {
    let [slot, lane, local] = at;
    let (mut sum, mut flux, mut deep, mut near) = (0.0, DVec3::ZERO, false, false);
    let mut parts = Vec::new();
    let mut met = BTreeSet::new();
    let (mut touching, mut touched) = (DVec3::ZERO, 0.0);
    let here = |tile: &Tile| tile.slot == slot && tile.lane == lane;
    for (number, tile) in tiling.tiles.iter().enumerate().filter(|(_, t)| here(t)) {
        let share = shares[number * tiling.workgroup() + local as usize];
        near |= share < 0.0;
        if share > 0.0 || share == TOUCHES {
            met.insert(tile.block);
        }
        if share == TOUCHES {
            let cell = tiling.cell(tile, local as usize).unwrap();
            touching += moving[tile.block as usize].at(centre(cell));
            touched += 1.0;
        }
        deep |= share == INTERIOR;
        let both = effective[number * tiling.workgroup() + local as usize].map(f64::from);
        parts.push((f64::from(share.clamp(0.0, 1.0)), both));
        let [fraction, _] = both;
        if fraction > 0.0 {
            let cell = tiling.cell(tile, local as usize).unwrap();
            sum += fraction;
            flux += fraction * moving[tile.block as usize].at(centre(cell));
        }
    }
    let filled: f64 = parts.iter().map(|(share, _)| share).sum();
    let (mark, velocity) = match (sum > 0.0, near) {
        (true, _) if deep => (sum + f64::from(INTERIOR_SUM), flux / sum),
        (true, _) if met.len() > 1 && filled > 0.9 => {
            // Parts that touch the cell contribute as the joint closes.
            let tight = ((filled - 0.9) / 0.098).min(1.0);
            let mean = (flux + tight * touching) / (sum + tight * touched);
            let most = parts.iter().map(|(share, _)| *share).fold(0.0, f64::max);
            let mark = if filled - most < 1e-3 {
                FACING_SUM
            } else {
                JOINT_SUM
            };
            (sum + f64::from(mark), mean)
        }
        (true, _) if met.len() > 1 => (sum + f64::from(SHARED_SUM), flux / sum),
        (true, _) => (sum, flux / sum),
        (false, true) => (f64::from(NEAR), DVec3::ZERO),
        (false, false) => (0.0, DVec3::ZERO),
    };
    (mark, velocity, together(&parts))
}

#[test]
fn shares_add_and_velocities_are_their_mean() {
    let cases = [
        (1, [4, 4, 4], None),
        (2, [5, 3, 7], Some(3)),
        (4, [7, 6, 1], Some(5)),
    ];
    let (mut shared, mut empty, mut left) = (0, 0, 0);
    for (seed, (lanes, brick, width)) in (10..).zip(cases) {
        let bench = Workbench::new(width);
        let mut noise = Random(seed);
        let middle = DVec3::new(4.0, 18.0, 9.0);
        let placed = crowd(&mut noise, 7, middle);
        let mut tiling = Tiling::new(grid([19, 20, 18], lanes, brick), [-5, 9, 0], placed);
        tiling.shorten(&mut noise);
        let moving: Vec<_> = (0..7).map(|_| Moving::new(middle, &mut noise)).collect();
        let shares = random_shares(&tiling, &mut noise);
        let effective = random_effective(&shares, &mut noise);
        let (lane_first, lane_tiles) = tiling.by_lane();
        let motions: Vec<_> = moving.iter().map(Moving::on_device).collect();
        let words = tiling.slots as usize * PLANES * shares.len() / tiling.tiles.len();
        let saturation = bench.poisoned(words * lanes as usize);
        // Every third lane is not listed; of the others every other tile from its first to its last cell.
        let listed = |row: &u32| row % 3 != 1;
        let whole = |row: u32| row.is_multiple_of(2);
        let job = |row| if whole(row) { row | WHOLE } else { row };
        let rows = (0..tiling.slots * lanes).rev().filter(listed);
        let mut work: Vec<u32> = rows.map(job).collect();
        work.insert(2, u32::MAX);
        let buffers = [
            ("work", &bench.buffer(&work)),
            ("tiles", &bench.buffer(&tiling.tiles)),
            ("motions", &bench.buffer(&motions)),
            ("lane_first", &bench.buffer(&lane_first)),
            ("lane_tiles", &bench.buffer(&lane_tiles)),
            ("solid_fractions", &bench.buffer(&shares)),
            ("effective_fractions", &bench.buffer(&effective)),
            ("psm_planes_0", &saturation),
        ];
        // Alternates between both kinds of walk.
        let walk = [CellMapping::Serial, CellMapping::Parallel][(seed % 2) as usize];
        let program = combine_parts(&tiling.grid, walk);
        let numbers = constants(&tiling.grid);
        bench.run(
            &program,
            "combine_parts",
            &numbers,
            &buffers,
            64 * work.len(),
        );
        let found: Vec<f32> = bench.read(&saturation);
        let size = tiling.workgroup() as u32;
        for slot in 0..tiling.slots {
            for (lane, local) in (0..lanes).flat_map(|a| (0..size).map(move |l| (a, l))) {
                let plane = |p: u32| {
                    let element = (slot * PLANES as u32 + p) * size + local;
                    found[(element * lanes + lane) as usize]
                };
                let untouched = |p: u32| plane(p).to_bits() == POISON;
                assert!((4..9).all(untouched), "planes of the fluid");
                let row = slot * lanes + lane;
                let reach = tiling.reach_of_lane(slot, lane);
                empty += u32::from(reach.is_empty());
                let reached = reach.contains(&(local as usize));
                if !listed(&row) || !(whole(row) || reached) {
                    let solid = [0, 1, 2, 3, 9];
                    assert!(
                        solid.into_iter().all(untouched),
                        "row {row}, {local}: not asked for"
                    );
                    left += 1;
                    continue;
                }
                let both = (&shares[..], &effective[..]);
                let (sum, u, fraction) = twin(&tiling, both, &moving, [slot, lane, local]);
                shared += u32::from(sum > 16.0);
                assert_near(f64::from(plane(0)), sum, 4e-6);
                assert_near(f64::from(plane(9)), fraction, 1e-4);
                for (a, expected) in u.to_array().into_iter().enumerate() {
                    let error = f64::from(plane(1 + a as u32)) - expected;
                    // Speeds are below 1.
                    assert!(error.abs() < 1e-6, "{error:e}");
                }
            }
        }
    }
    assert!(
        shared > 20 && empty > 0 && left > 1000,
        "{shared} {empty} {left}"
    );
}
