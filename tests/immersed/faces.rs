//! Loads on single faces.

use crate::{
    exact::Solid,
    saturate::{Moving, random_shares},
    shapes::{cuboid, icosahedron, tetrahedron},
    tiling::{Noise, Placed, Tiling, centre, grid},
    voxelise,
    workbench::{POISON, Workbench},
};
use glam::{DQuat, DVec3};
use riprap::{
    block::{HalfSpace, Polyhedron},
    immersed::{DEEP, FACE_LOAD, FaceJob, PLANES, Tile, constants, reduce_faces, sum_faces},
};

/// Parts and what a step of the fluid would leave in their cells.
struct Case {
    tiling: Tiling,
    moving: Vec<Moving>,
    shares: Vec<f32>,
    saturation: Vec<f32>,
    /// Parts that ask.
    asked: Vec<u32>,
}

impl Case {
    /// `shares` as they may be, or exact ones.
    fn new(tiling: Tiling, shares: Option<Vec<f32>>, noise: &mut Noise) -> Self {
        let blocks = tiling.placed.iter().map(|p| p.block).max().unwrap() + 1;
        let near = tiling.placed[0].centre;
        let moving = (0..blocks).map(|_| Moving::new(near, noise)).collect();
        let exact = shares.is_some();
        let shares = shares.unwrap_or_else(|| random_shares(&tiling, noise));
        let scalars =
            tiling.slots as usize * PLANES * tiling.workgroup() * tiling.grid.lanes as usize;
        let mut saturation = vec![f32::from_bits(POISON); scalars];
        for (number, tile) in tiling.tiles.iter().enumerate() {
            for local in 0..tiling.workgroup() {
                if shares[number * tiling.workgroup() + local] <= 0.0 {
                    continue;
                }
                let fluid = exact || noise.next() > 0.3;
                for plane in 4..PLANES {
                    let any = noise.next() as f32;
                    saturation[tiling.scalar(tile, plane, local)] = if fluid { any } else { 0.0 };
                }
            }
        }
        let asked = (0..tiling.parts.len() as u32).filter(|n| n % 3 != 1);
        Self {
            asked: asked.collect(),
            tiling,
            moving,
            shares,
            saturation,
        }
    }

    /// Face by face: part, number of the face.
    fn faces(&self) -> impl Iterator<Item = (u32, u32)> {
        let faces = |part: &u32| self.tiling.parts[*part as usize].faces;
        let each = self.asked.iter().map(move |part| (*part, faces(part)));
        each.flat_map(|(part, faces)| (0..faces).map(move |face| (part, face)))
    }

    /// Loads on each face, and the sums of the sizes of what adds up to them.
    fn twin(&self) -> Vec<[(f64, f64); FACE_LOAD]> {
        let one = |(part, face)| {
            let mut all = [(0.0, 0.0); FACE_LOAD];
            let tiles = self.tiling.tiles.iter().enumerate();
            for (number, tile) in tiles.filter(|(_, tile)| tile.part == part) {
                for local in 0..self.tiling.workgroup() {
                    let share = self.shares[number * self.tiling.workgroup() + local];
                    if share > 0.0 && share != DEEP {
                        let values = self.cell(tile, local, face as usize, share.into());
                        for (sum, value) in all.iter_mut().zip(values) {
                            *sum = (sum.0 + value, sum.1 + value.abs());
                        }
                    }
                }
            }
            all
        };
        self.faces().map(one).collect()
    }

    fn cell(&self, tile: &Tile, local: usize, face: usize, e: f64) -> [f64; FACE_LOAD] {
        let placed = &self.tiling.placed[tile.part as usize];
        let point = centre(self.tiling.cell(tile, local).unwrap());
        let r = point - placed.centre;
        let own = &placed.faces[face];
        let height = own.height(r);
        // The first of those that are highest.
        let heights = || placed.faces.iter().map(|other| other.height(r));
        let highest = heights().fold(f64::MIN, f64::max);
        let owner = heights().position(|h| h > highest - 1e-9) == Some(face);
        let half = own.normal.abs().element_sum() / 2.0;
        let passes = height >= -half - 1e-5 && height < half - 1e-5;
        let at = |plane| f64::from(self.saturation[self.tiling.scalar(tile, plane, local)]);
        let area = if passes && at(4) > 0.0 {
            let inside = placed.faces.iter().fold(Solid::cell(r), Solid::cut);
            // Within rounding beyond the cell it counts as its side.
            let distance = own.distance.min(own.normal.dot(r) + half);
            inside.area_in(&HalfSpace { distance, ..*own })
        } else {
            0.0
        };
        let moving = &self.moving[tile.block as usize];
        let f = -e * (at(5) * moving.at(point) + DVec3::new(at(6), at(7), at(8)));
        let (f, n) = if owner { (f, 1.0) } else { (DVec3::ZERO, 0.0) };
        let m = (point - moving.centre).cross(f);
        [f.x, f.y, f.z, m.x, m.y, m.z, area, n]
    }

    /// The same by the kernels.
    fn run(&self, width: Option<u32>) -> Vec<f32> {
        let bench = Workbench::new(width);
        let (mut jobs, mut face_first) = (Vec::new(), vec![0]);
        for (part, face) in self.faces() {
            let numbers = (0..).zip(&self.tiling.tiles);
            let own = numbers.filter(|(_, tile)| tile.part == part);
            jobs.extend(own.map(|(tile, _)| FaceJob { tile, face }));
            face_first.push(jobs.len() as u32);
        }
        let motions: Vec<_> = self.moving.iter().map(Moving::on_device).collect();
        let faces = face_first.len() - 1;
        let partials = bench.poisoned(FACE_LOAD * (jobs.len() + 1));
        let loads = bench.poisoned(FACE_LOAD * (faces + 8));
        let buffers = [
            ("jobs", &bench.buffer(&jobs)),
            ("tiles", &bench.buffer(&self.tiling.tiles)),
            ("parts", &bench.buffer(&self.tiling.parts)),
            ("faces", &bench.buffer(&self.tiling.faces)),
            ("motions", &bench.buffer(&motions)),
            ("shares", &bench.buffer(&self.shares)),
            ("saturation", &bench.buffer(&self.saturation)),
            ("face_first", &bench.buffer(&face_first)),
            ("face_partials", &partials),
            ("face_loads", &loads),
        ];
        let numbers = constants(&self.tiling.grid);
        let program = reduce_faces(&self.tiling.grid);
        // One group more than there are jobs.
        let groups = 64 * (jobs.len() + 1);
        bench.run(&program, "reduce_faces", &numbers, &buffers, groups);
        let invocations = FACE_LOAD * (faces + 8);
        bench.run(&sum_faces(), "sum_faces", &[], &buffers, invocations);
        let poison = |numbers: &[f32]| numbers.iter().all(|x| x.to_bits() == POISON);
        assert!(poison(
            &bench.read::<f32>(&partials)[FACE_LOAD * jobs.len()..]
        ));
        let mut found: Vec<f32> = bench.read(&loads);
        assert!(poison(&found.split_off(FACE_LOAD * faces)));
        found
    }
}

/// Compounds, and blocks that do not ask.
fn blocks(noise: &mut Noise) -> Vec<Placed> {
    let shapes = [
        (0, cuboid(7.0, 5.0, 6.0)),
        (0, tetrahedron(8.0)),
        (1, icosahedron(6.0)),
        (2, tetrahedron(7.0)),
        (2, cuboid(9.0, 4.0, 0.4)),
    ];
    let place = |(block, shape): &(u32, Polyhedron)| {
        let at = DVec3::new(8.0, 9.0, 10.0) + noise.point();
        Placed::hull(*block, shape, at, noise.rotation())
    };
    shapes.iter().map(place).collect()
}

fn check(case: &Case, width: Option<u32>) {
    let expected = case.twin();
    let found = case.run(width);
    assert_eq!(found.len(), FACE_LOAD * expected.len());
    for (face, (found, expected)) in found.chunks(FACE_LOAD).zip(&expected).enumerate() {
        for (k, (found, (value, size))) in found.iter().zip(expected).enumerate() {
            // Areas are exact to f32 in each cell; in cells that the face just touches that is all there is.
            let most = 3e-6 * size + if k == 6 { 1e-4 } else { 0.0 };
            let error = (f64::from(*found) - value).abs();
            assert!(error <= most, "face {face}, {k}: {found} {value}");
        }
        assert!(expected[7].0 > 0.0, "face {face} has cells");
    }
}

#[test]
fn loads_on_faces_are_sums_over_their_cells() {
    let cases = [
        (1, [4, 4, 4], None),
        (2, [5, 3, 7], Some(3)),
        (4, [4, 8, 8], None),
    ];
    for (seed, (lanes, brick, width)) in (30..).zip(cases) {
        let mut noise = Noise(seed);
        let grid = grid([19, 20, 21], lanes, brick);
        let tiling = Tiling::new(grid, [0; 3], blocks(&mut noise));
        check(&Case::new(tiling, None, &mut noise), width);
    }
}

/// In fluid all of a face is wet, and together the faces feel all that the block feels but its depths;
/// also where faces lie along the grid and no cell is mixed.
#[test]
fn faces_together_are_the_block() {
    let mut noise = Noise(40);
    let shape = cuboid(8.0, 6.0, 5.0);
    for (at, rotation) in [
        (DVec3::new(8.0, 8.0, 8.5), DQuat::IDENTITY),
        (DVec3::new(8.25, 8.5, 8.0), DQuat::IDENTITY),
        // Within rounding of it.
        (DVec3::new(8.000003, 8.0, 8.5), DQuat::IDENTITY),
        (DVec3::new(8.1, 8.2, 8.3), noise.rotation()),
    ] {
        let placed = vec![Placed::hull(0, &shape, at, rotation)];
        let tiling = Tiling::new(grid([17; 3], 1, [4; 3]), [0; 3], placed);
        let shares = voxelise::all(&Workbench::new(None), &tiling);
        let case = Case::new(tiling, Some(shares), &mut noise);
        check(&case, None);
        let found = case.run(None);
        for (face, found) in shape.faces().iter().zip(found.chunks(FACE_LOAD)) {
            let across = [8.0, 6.0, 5.0];
            let along = (0..3).find(|a| face.normal[*a].abs() > 0.5).unwrap();
            let area = 240.0 / across[along];
            // A cell that holds less than 1e-6 counts as empty: of the face it may hold 1e-4.
            let error = f64::from(found[6]) / area - 1.0;
            assert!(error.abs() < 1e-4, "{error:e}");
        }
        let cells: f32 = found.chunks(FACE_LOAD).map(|load| load[7]).sum();
        let shallow = case.shares.iter().filter(|s| **s > 0.0 && **s != DEEP);
        assert_eq!(cells as usize, shallow.count());
    }
}
