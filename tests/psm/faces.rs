//! Loads on single faces.

use crate::{
    combine_solids::{Moving, random_shares},
    shapes::{cuboid, icosahedron, tetrahedron},
    tiling::{Placed, Tiling, centre, grid, rotation},
    voxelise,
};
use glam::{DQuat, DVec3};
use kit::{POISON, Random, Workbench, assert_relative};
use riprap::{
    geometry::{HalfSpace, Polyhedron},
    psm::{
        CellMapping, FACE_LAYERS, FACE_LOAD, FaceJob, NEAR, PLANES, Tile, constants, reduce_faces,
        sum_faces,
    },
};

/// Viscosity of the fluid, cells² per step.
const VISCOSITY: f64 = 0.07;

/// Parts, and a state of the fluid in their cells as after a step.
struct Case {
    tiling: Tiling,
    moving: Vec<Moving>,
    shares: Vec<f32>,
    saturation: Vec<f32>,
    /// Parts whose face loads are requested.
    asked: Vec<u32>,
}

impl Case {
    /// Random solid fractions; or the given exact ones, with fluid around them of density 1.03 everywhere.
    fn new(tiling: Tiling, shares: Option<Vec<f32>>, noise: &mut Random) -> Self {
        let blocks = tiling.placed.iter().map(|p| p.block).max().unwrap() + 1;
        let near = tiling.placed[0].centre;
        let moving = (0..blocks).map(|_| Moving::new(near, noise)).collect();
        let exact = shares.is_some();
        let shares = shares.unwrap_or_else(|| {
            let mut shares = random_shares(&tiling, noise);
            for share in shares.iter_mut().filter(|share| **share > 0.0) {
                *share = if noise.unit() > 0.3 { NEAR } else { *share };
            }
            shares
        });
        let scalars =
            tiling.slots as usize * PLANES * tiling.workgroup() * tiling.grid.lanes as usize;
        let mut saturation = vec![f32::from_bits(POISON); scalars];
        for (number, tile) in tiling.tiles.iter().enumerate() {
            for local in 0..tiling.workgroup() {
                let share = shares[number * tiling.workgroup() + local];
                if share > 0.0 {
                    continue;
                }
                let any = noise.unit();
                let empty = if share < 0.0 { NEAR } else { 0.0 };
                let mark = if exact || any > 0.2 {
                    empty
                } else {
                    5.0 * any as f32
                };
                saturation[tiling.scalar(tile, 0, local)] = mark;
                let fluid = exact || any > 0.4;
                saturation[tiling.scalar(tile, 4, local)] = if fluid { 1.0 } else { 0.0 };
                for plane in 5..PLANES - 1 {
                    let any = 0.1 * (noise.unit() - 0.5) as f32;
                    let value = if exact && plane == 5 { 0.03 } else { any };
                    saturation[tiling.scalar(tile, plane, local)] = value;
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

    /// The layers of all requested faces: part, index of the face, layer.
    fn layers(&self) -> impl Iterator<Item = (u32, u32, u32)> {
        let faces = |part: &u32| self.tiling.parts[*part as usize].faces;
        let each = self.asked.iter().map(move |part| (*part, faces(part)));
        each.flat_map(|(part, faces)| {
            let face = move |face| (0..FACE_LAYERS as u32).map(move |layer| (part, face, layer));
            (0..faces).flat_map(face)
        })
    }

    /// Loads on each layer, and the sums of the absolute values of their terms, 0 for exact ones.
    fn twin(&self) -> Vec<[(f64, f64); FACE_LOAD]> {
        let one = |(part, face, layer)| {
            let mut all = [(0.0, 0.0); FACE_LOAD];
            let tiles = self.tiling.tiles.iter().enumerate();
            for (number, tile) in tiles.filter(|(_, tile)| tile.part == part) {
                for local in 0..self.tiling.workgroup() {
                    let share = self.shares[number * self.tiling.workgroup() + local];
                    if share > 0.0 || (layer == 0 && share == 0.0) {
                        continue;
                    }
                    let values = self.cell(tile, local, (face as usize, f64::from(layer)));
                    for (sum, (value, size)) in all.iter_mut().zip(values.unwrap_or_default()) {
                        *sum = (sum.0 + value, sum.1 + size);
                    }
                }
            }
            all
        };
        self.layers().map(one).collect()
    }

    /// Terms of a cell and their absolute values, if it is in the layer along the face.
    fn cell(
        &self,
        tile: &Tile,
        local: usize,
        (face, layer): (usize, f64),
    ) -> Option<[(f64, f64); FACE_LOAD]> {
        let placed = &self.tiling.placed[tile.part as usize];
        let point = centre(self.tiling.cell(tile, local)?);
        let r = point - placed.centre;
        let own = &placed.faces[face];
        let normal = own.normal;
        let height = own.height(r);
        let foot = point - height * normal;
        // The distance from the centre of a cell to the farthest corner along the normal.
        let low = 0.5 * normal.abs().element_sum() - 1e-5 + layer;
        let others = placed.faces.iter().enumerate();
        let mut others = others.filter(|(n, _)| *n != face).map(|(_, other)| other);
        // Feet on an edge belong to both faces.
        let inside = others.all(|other| other.height(foot - placed.centre) < 1e-9);
        if !(low..low + 1.0).contains(&height) || !inside {
            return None;
        }
        let siblings = self.tiling.placed.iter().enumerate().filter(|(n, other)| {
            *n != tile.part as usize && other.block == self.tiling.parts[tile.part as usize].block
        });
        let siblings = siblings.map(|(_, other)| other);
        // A point a thousandth of a cell above the face.
        let over = foot + 1e-3 * normal;
        if siblings.clone().any(|other| {
            other
                .faces
                .iter()
                .all(|f| f.height(over - other.centre) < 0.0)
        }) {
            return None;
        }
        let cut = siblings.into_iter().any(|other| {
            let reach = |f: &HalfSpace| 0.5 * f.normal.abs().element_sum() - 1e-5;
            let faces = other.faces.iter();
            faces
                .into_iter()
                .all(|f| f.height(point - other.centre) < reach(f))
        });
        let at = |plane| f64::from(self.saturation[self.tiling.scalar(tile, plane, local)]);
        if at(0) > 0.0 || at(4) == 0.0 {
            if cut || (at(0) > 0.0 && at(0) < 0.5) {
                return None;
            }
            let mut dry = [(0.0, 0.0); FACE_LOAD];
            dry[FACE_LOAD - 1].0 = 1.0;
            return Some(dry);
        }
        let moving = &self.moving[tile.block as usize];
        let slip = DVec3::new(at(6), at(7), at(8)) - moving.at(foot);
        let shear = VISCOSITY / height * (slip - slip.dot(normal) * normal);
        let t = shear - at(5) / 3.0 * normal;
        let arm = foot - moving.centre;
        let m = arm.cross(t);
        let along = |v: DVec3, size: f64| v.to_array().map(|x| (x, size));
        let [[a, b, c], [d, e, f]] = [along(t, t.length()), along(m, arm.length() * t.length())];
        let mut all = [(1.0, 0.0); FACE_LOAD];
        all[..6].copy_from_slice(&[a, b, c, d, e, f]);
        all[6] = (height, height);
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            all[7 + k] = (arm[k], arm.length());
            all[10 + k] = (arm[k] * arm[k], arm.length_squared());
            all[13 + k] = (arm[i] * arm[j], arm.length_squared());
        }
        Some(all)
    }

    /// The loads on each layer, computed by the kernels.
    fn run(&self, walk: CellMapping, width: Option<u32>) -> Vec<f32> {
        let bench = Workbench::new(width);
        let (mut jobs, mut face_first) = (Vec::new(), vec![0]);
        for (part, face, layer) in self.layers() {
            let numbers = (0..).zip(&self.tiling.tiles);
            let own = numbers.filter(|(_, tile)| tile.part == part);
            jobs.extend(own.map(|(tile, _)| FaceJob { tile, face, layer }));
            face_first.push(jobs.len() as u32);
        }
        let motions: Vec<_> = self.moving.iter().map(Moving::on_device).collect();
        let layers = face_first.len() - 1;
        let partials = bench.poisoned(FACE_LOAD * (jobs.len() + 1));
        let loads = bench.poisoned(FACE_LOAD * (layers + 8));
        let buffers = [
            ("jobs", &bench.buffer(&jobs)),
            ("tiles", &bench.buffer(&self.tiling.tiles)),
            ("parts", &bench.buffer(&self.tiling.parts)),
            ("faces", &bench.buffer(&self.tiling.faces)),
            ("motions", &bench.buffer(&motions)),
            ("solid_fractions", &bench.buffer(&self.shares)),
            ("psm_planes_0", &bench.buffer(&self.saturation)),
            ("face_first", &bench.buffer(&face_first)),
            ("face_partials", &partials),
            ("face_loads", &loads),
        ];
        let mut numbers = constants(&self.tiling.grid);
        numbers.push(("VISCOSITY", VISCOSITY));
        let program = reduce_faces(&self.tiling.grid, walk);
        // One workgroup more than the jobs require.
        let groups = walk.groups(jobs.len() as u32) as usize + 1;
        bench.run(&program, "reduce_faces", &numbers, &buffers, 64 * groups);
        let invocations = FACE_LOAD * (layers + 8);
        bench.run(&sum_faces(), "sum_faces", &[], &buffers, invocations);
        let poison = |numbers: &[f32]| numbers.iter().all(|x| x.to_bits() == POISON);
        assert!(poison(
            &bench.read::<f32>(&partials)[FACE_LOAD * jobs.len()..]
        ));
        let mut found: Vec<f32> = bench.read(&loads);
        assert!(poison(&found.split_off(FACE_LOAD * layers)));
        found
    }
}

/// Compounds with overlapping parts, and blocks whose face loads are not requested.
fn blocks(noise: &mut Random) -> Vec<Placed> {
    let shapes = [
        (0, cuboid(7.0, 5.0, 6.0)),
        (0, tetrahedron(8.0)),
        (1, icosahedron(6.0)),
        (2, tetrahedron(7.0)),
        (2, cuboid(9.0, 4.0, 0.4)),
    ];
    let place = |(block, shape): &(u32, Polyhedron)| {
        let at = DVec3::new(8.0, 9.0, 10.0) + noise.point();
        Placed::hull(*block, shape, at, rotation(noise))
    };
    shapes.iter().map(place).collect()
}

fn check(case: &Case, width: Option<u32>) {
    let expected = case.twin();
    for walk in [CellMapping::Serial, CellMapping::Parallel] {
        let found = case.run(walk, width);
        assert_eq!(found.len(), FACE_LOAD * expected.len());
        for (row, (found, expected)) in found.chunks(FACE_LOAD).zip(&expected).enumerate() {
            for (k, (found, (value, size))) in found.iter().zip(expected).enumerate() {
                // The error of f32 in each cell; heights have the rounding of positions some 10 cells away.
                let error = (f64::from(*found) - value).abs();
                assert!(error <= 3e-6 * size, "layer {row}, {k}: {found} {value}");
            }
        }
    }
    // The narrow sides of a slab may have no cells.
    let seen = expected
        .iter()
        .filter(|sums| sums[FACE_LOAD - 1].0 > 0.0)
        .count();
    assert!(2 * seen > expected.len(), "{seen} of {}", expected.len());
}

#[test]
fn loads_on_faces_are_sums_over_layers_of_cells() {
    let cases = [
        (1, [4, 4, 4], None),
        (2, [5, 3, 7], Some(3)),
        (4, [4, 8, 8], None),
    ];
    for (seed, (lanes, brick, width)) in (30..).zip(cases) {
        let mut noise = Random(seed);
        let grid = grid([19, 20, 21], lanes, brick);
        let tiling = Tiling::new(grid, [0; 3], blocks(&mut noise));
        check(&Case::new(tiling, None, &mut noise), width);
    }
}

/// One cell of fluid per unit of area in each layer: exact for faces along the grid, also within rounding of it.
#[test]
fn layers_along_a_face_have_its_area() {
    let mut noise = Random(40);
    let shape = cuboid(8.0, 6.0, 5.0);
    for (at, rotation) in [
        (DVec3::new(8.0, 8.0, 8.5), DQuat::IDENTITY),
        (DVec3::new(8.25, 8.0, 8.5), DQuat::IDENTITY),
        (DVec3::new(8.000003, 8.0, 8.5), DQuat::IDENTITY),
        (DVec3::new(8.1, 8.2, 8.3), rotation(&mut noise)),
    ] {
        let along_grid = rotation == DQuat::IDENTITY;
        let placed = vec![Placed::hull(0, &shape, at, rotation)];
        let tiling = Tiling::new(grid([17; 3], 1, [4; 3]), [0; 3], placed);
        let shares = voxelise::all(&Workbench::new(None), &tiling);
        let case = Case::new(tiling, Some(shares), &mut noise);
        check(&case, None);
        let found = case.run(CellMapping::Serial, None);
        let rows = found.chunks(FACE_LOAD).enumerate();
        for (row, found) in rows {
            let (face, layer) = (&shape.faces()[row / FACE_LAYERS], row % FACE_LAYERS);
            let across = [8.0, 6.0, 5.0];
            let along = (0..3).find(|a| face.normal[*a].abs() > 0.5).unwrap();
            let area = 240.0 / across[along];
            let [height, fluid, cells] =
                [6, FACE_LOAD - 2, FACE_LOAD - 1].map(|k| f64::from(found[k]));
            assert_eq!(fluid, cells, "all is wet");
            // Feet within a tenth of a cell from edges of 22 to 28 cells may fall on either side.
            let most = if along_grid { 0.0 } else { 0.1 };
            let error = cells / area - 1.0;
            println!("{cells} cells of {area}");
            assert!(error.abs() <= most, "{cells} of {area}");
            let normal = rotation * face.normal;
            let force = DVec3::new(found[0].into(), found[1].into(), found[2].into());
            let pressure = -force.dot(normal) / cells;
            assert_relative(pressure, 0.01, 1e-5);
            let half = 0.5 * normal.abs().element_sum();
            let mean = height / cells - half - layer as f64;
            assert!((-1e-5..1.0).contains(&mean), "{mean}");
        }
    }
}
