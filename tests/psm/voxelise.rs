//! Solid fractions against exact volumes.

use crate::{
    exact::{polyhedron_fraction, sphere_fraction},
    shapes::{cuboid, icosahedron, pebble, rotations, tetrahedron},
    tiling::{Placed, Tiling, centre, grid, rotation},
};
use glam::{DQuat, DVec3};
use kit::{POISON, Random, Workbench};
use riprap::{
    geometry::HalfSpace,
    lattice::SolidWeight,
    psm::{
        CellMapping, Forms, INTERIOR, NEAR, TOUCHES, Tile, WHOLE, constants, voxelise,
        voxelise_edges,
    },
};

/// Constant c of the exact weight, cells².
pub const GROWTH: f64 = 0.4;

/// The shares of the listed tiles, bitwise equal for both kinds of walk; tiles that are not listed stay poisoned.
fn run(bench: &Workbench, tiling: &Tiling, work: &[u32]) -> Vec<f32> {
    let [shares, effective] = both(bench, tiling, work, SolidWeight::Standard);
    // With the weight of the paper the effective fraction is the solid fraction.
    let poison = |value: f32| value.to_bits() == POISON;
    let equal = |(share, effective): (&f32, &[f32])| {
        let equal = |e: &f32| (poison(*share) && poison(*e)) || share.clamp(0.0, 1.0) == *e;
        effective.iter().all(equal)
    };
    assert!(shares.iter().zip(effective.chunks(2)).all(equal));
    shares
}

/// Shares and effective fractions, two per cell.
pub fn both(
    bench: &Workbench,
    tiling: &Tiling,
    work: &[u32],
    weight: SolidWeight,
) -> [Vec<f32>; 2] {
    let [serial, parallel] = [CellMapping::Serial, CellMapping::Parallel]
        .map(|walk| walked(bench, tiling, work, (walk, weight)));
    let bits = |shares: &[f32]| shares.iter().map(|s| s.to_bits()).collect::<Vec<_>>();
    let same = serial.each_ref().map(|s| bits(s)) == parallel.each_ref().map(|s| bits(s));
    assert!(same, "the walks differ");
    serial
}

fn walked(
    bench: &Workbench,
    tiling: &Tiling,
    work: &[u32],
    (walk, weight): (CellMapping, SolidWeight),
) -> [Vec<f32>; 2] {
    let cells = tiling.tiles.len() * tiling.workgroup();
    let (shares, effective) = (bench.poisoned(cells), bench.poisoned(2 * cells));
    // An empty list in poisoned memory.
    let mut list = vec![POISON; cells + 1];
    list[0] = 0;
    let edges = bench.buffer(&list);
    let buffers = [
        ("work", &bench.buffer(work)),
        ("tiles", &bench.buffer(&tiling.tiles)),
        ("parts", &bench.buffer(&tiling.parts)),
        ("faces", &bench.buffer(&tiling.faces)),
        ("solid_fractions", &shares),
        ("effective_fractions", &effective),
        ("edges", &edges),
    ];
    let mut numbers = constants(&tiling.grid);
    numbers.push(("SPHERE_GROWTH", GROWTH));
    let program = voxelise(&tiling.grid, walk, Forms::ALL, weight);
    bench.run(&program, "voxelise", &numbers, &buffers, 64 * work.len());
    let program = voxelise_edges(&tiling.grid, Forms::ALL, weight);
    // Fewer invocations than cells at edges, so that each processes several.
    bench.run(&program, "voxelise_edges", &numbers, &buffers, 128);
    [bench.read(&shares), bench.read(&effective)]
}

/// The shares of all tiles.
pub fn all(bench: &Workbench, tiling: &Tiling) -> Vec<f32> {
    let work: Vec<u32> = (0..tiling.tiles.len() as u32).collect();
    run(bench, tiling, &work)
}

/// Solid fraction from a share and its marks.
pub fn fraction(share: f32) -> f64 {
    f64::from(share.clamp(0.0, 1.0))
}

fn sum(shares: &[f32]) -> f64 {
    shares.iter().map(|s| fraction(*s)).sum()
}

/// Height above a hull's highest face, in half widths of a cell, and this half width.
fn highest(placed: &Placed, r: DVec3) -> (f64, f64) {
    let heights = placed.faces.iter().map(|face| {
        let w = face.normal.abs().element_sum() / 2.0;
        (face.height(r) / w, w)
    });
    heights.fold((f64::MIN, 0.0), |a, b| if b.0 > a.0 { b } else { a })
}

/// Checks the marks of a cell; `exact` is its solid fraction.
fn check_marks(placed: &Placed, r: DVec3, share: f32, exact: f64) {
    // Within rounding of a limit, either mark is correct.
    const EDGE: f64 = 1e-4;
    let around = |layers: f64| r.abs() + layers + 0.5;
    let beside = |layers: f64| (r.abs() - layers - 0.5).max(DVec3::ZERO).length();
    let (inside, far) = if placed.faces.is_empty() {
        let inside = placed.radius - around(2.0).length();
        (inside, beside(1.0) - placed.radius)
    } else {
        let (height, w) = highest(placed, r);
        let box_gap = (placed.low - r).max(r - placed.high).max_element();
        // Five half widths below every face: two more layers of cells are below it.
        ((-5.0 - height) * w, ((height - 3.0) * w).max(box_gap - 1.5))
    };
    if inside > EDGE {
        assert_eq!(share, INTERIOR, "{r} is deep");
    } else if inside < -EDGE {
        assert_ne!(share, INTERIOR, "{r} is not deep");
    }
    if far > EDGE {
        assert_eq!(share, 0.0, "{r} is far");
    } else if far < -EDGE {
        assert_ne!(share, 0.0, "{r} is near");
    }
    if share == TOUCHES {
        let (height, w) = highest(placed, r);
        let gap = (height - 1.0) * w;
        assert!(exact < 1e-5 && gap < 1e-3 + EDGE, "{r} touches over {gap}");
    }
    if exact < 1e-8 {
        assert!(share <= 2e-6, "{r} is empty: {share}");
    }
}

/// Rounding error of f32 over the few dozen terms of a cell's volume.
const ROUNDING: f64 = 2e-6;
/// The error if a face of the part is almost parallel to a face of the cell, which the kernel treats as parallel.
const ALMOST_PARALLEL: f64 = 1e-4;

/// Error of the columns: at an edge of the part their lengths have a kink. Between columns 1/8 apart a change of slope by 2
/// costs at most 2/8/8² of a cell; faces that are steep relative to the columns, and several edges, cost more.
const COLUMNS: f64 = 1e-2;

/// Number of faces that cut the cell around r.
fn cuts(placed: &Placed, r: DVec3) -> usize {
    let cut = |face: &&HalfSpace| face.height(r).abs() < face.normal.abs().element_sum() / 2.0;
    placed.faces.iter().filter(cut).count()
}

/// Checks every cell of every tile; `most` is the largest error of a fraction.
fn check_cells(tiling: &Tiling, shares: &[f32], most: f64) -> f64 {
    let mut worst = 0f64;
    for (tile, shares) in tiling.tiles.iter().zip(shares.chunks(tiling.workgroup())) {
        let placed = &tiling.placed[tile.part as usize];
        for (local, &share) in shares.iter().enumerate() {
            let Some(cell) = tiling.cell(tile, local) else {
                assert_eq!(share, 0.0, "beyond the domain");
                continue;
            };
            let r = centre(cell) - placed.centre;
            let outside = (placed.low - r).max(r - placed.high).max_element() > 0.5;
            let exact = match placed.faces.is_empty() {
                _ if outside => 0.0,
                true if (r.abs() + 0.5).length() <= placed.radius => 1.0,
                true => sphere_fraction(placed.radius, r),
                false => polyhedron_fraction(&placed.faces, r),
            };
            check_marks(placed, r, share, exact);
            let marks = [INTERIOR, NEAR, TOUCHES];
            let known = marks.contains(&share) || (0.0..=1.0).contains(&share);
            assert!(known, "{share}");
            let most = if cuts(placed, r) > 7 { COLUMNS } else { most };
            worst = worst.max((fraction(share) - exact).abs() / most);
        }
    }
    assert!(worst < 1.0, "{worst} of what is allowed");
    worst
}

/// Grids whose sizes are not multiples of bricks and lanes, about `size` cells along an axis.
fn grids(size: u32) -> [riprap::lattice::Grid; 4] {
    [
        grid([size; 3], 1, [4, 4, 4]),
        grid([size, size + 1, size + 2], 2, [5, 3, 7]),
        grid([size + 3, size, size + 1], 4, [8, 2, 4]),
        grid([size + 1, size + 2, size + 3], 4, [7, 6, 1]),
    ]
}

/// Cells next to the faces of a cube along the grid, to within a thousandth of a cell, and not those next to its edges.
#[test]
fn cells_that_touch_a_cube() {
    let bench = Workbench::new(None);
    for (gap, faces) in [(-4e-4, 6), (0.0, 6), (9e-4, 6), (1.2e-3, 0)] {
        let cube = cuboid(4.0 - 2.0 * gap, 4.0 - 2.0 * gap, 4.0 - 2.0 * gap);
        let at = DVec3::splat(6.0);
        let placed = vec![Placed::hull(0, &cube, at, DQuat::IDENTITY)];
        let tiling = Tiling::new(grid([12; 3], 1, [4, 4, 4]), [0; 3], placed);
        let shares = all(&bench, &tiling);
        let touching = shares.iter().filter(|share| **share == TOUCHES).count();
        // A larger cube extends into these cells.
        let expected = if gap < 0.0 { 0 } else { faces * 16 };
        assert_eq!(touching, expected, "{gap}");
        check_cells(&tiling, &shares, ALMOST_PARALLEL);
    }
}

#[test]
fn each_cell_of_polyhedra() {
    let mut noise = Random(1);
    let shapes = [
        cuboid(9.0, 7.0, 8.0),
        tetrahedron(11.0),
        icosahedron(8.0),
        // Thinner than a cell.
        cuboid(9.0, 6.0, 0.3),
        // Smaller than a cell.
        tetrahedron(0.7),
    ];
    let bench = Workbench::new(None);
    let mut worst = 0f64;
    for shape in &shapes {
        for (n, rotation) in rotations(4, &mut noise).into_iter().enumerate() {
            // Whole, half and any offsets.
            let offset = match n % 3 {
                0 => DVec3::ZERO,
                1 => DVec3::new(0.5, 0.0, 0.5),
                _ => noise.point(),
            };
            let at = DVec3::splat(9.0) + offset;
            let placed = vec![Placed::hull(0, shape, at, rotation)];
            let tiling = Tiling::new(grids(18)[n % 4], [0; 3], placed);
            let shares = all(&bench, &tiling);
            let most = if [4, 5].contains(&n) {
                ALMOST_PARALLEL
            } else {
                ROUNDING
            };
            worst = worst.max(check_cells(&tiling, &shares, most));
        }
    }
    assert!(worst > 0.0);
}

/// Faces that are almost along the grid and pass through corners of cells, below the resolution of f32.
#[test]
fn each_cell_of_a_cube_that_is_hardly_turned() {
    let bench = Workbench::new(None);
    let cube = cuboid(8.0, 8.0, 8.0);
    let mut placed = Vec::new();
    for angle in [1e-5, 3e-5, 1e-4, 2e-4, 2.9e-4, 3.1e-4, 1e-3] {
        for axis in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE.normalize()] {
            for at in [DVec3::splat(6.0), DVec3::new(6.5, 6.0, 5.5)] {
                for turn in [angle, -angle] {
                    let rotation = DQuat::from_axis_angle(axis, turn);
                    placed.push(Placed::hull(0, &cube, at, rotation));
                }
            }
        }
    }
    let tiling = Tiling::new(grid([13; 3], 1, [8, 8, 4]), [0; 3], placed);
    check_cells(&tiling, &all(&bench, &tiling), ALMOST_PARALLEL);
}

/// Cells that a part cannot reach are skipped, unless the whole tile is requested.
#[test]
fn cells_out_of_reach_are_left_alone() {
    let bench = Workbench::new(None);
    let mut noise = Random(8);
    for grid in grids(18) {
        let at = DVec3::splat(9.0) + noise.point();
        let placed = vec![Placed::hull(0, &icosahedron(9.0), at, rotation(&mut noise))];
        let mut tiling = Tiling::new(grid, [0; 3], placed);
        let expected = all(&bench, &tiling);
        tiling.shorten(&mut noise);
        let whole = |tile: u32| tile % 2 == 1;
        let tiles = 0..tiling.tiles.len() as u32;
        let job = |tile| if whole(tile) { tile | WHOLE } else { tile };
        let work: Vec<u32> = tiles.clone().map(job).collect();
        let found = run(&bench, &tiling, &work);
        let size = tiling.workgroup();
        let mut left = 0;
        for (tile, at) in tiles.flat_map(|tile| (0..size).map(move |at| (tile, at))) {
            let reach = tiling.reach(&tiling.tiles[tile as usize]);
            let place = tile as usize * size + at;
            let done = whole(tile) || reach.contains(&at);
            let bits = if done {
                expected[place].to_bits()
            } else {
                POISON
            };
            left += u32::from(!done);
            assert_eq!(found[place].to_bits(), bits, "tile {tile}, place {at}");
        }
        assert!(left > 100, "{left}");
    }
}

/// No accuracy is lost far from the origin of the coordinates, as for blocks next to a periodic face.
#[test]
fn each_cell_far_from_the_origin() {
    let bench = Workbench::new(None);
    let origin = [-3, 1_000_000, -70_000];
    let at = centre(origin) + DVec3::new(6.25, 7.5, 6.125);
    let rotation = rotation(&mut Random(5));
    let placed = vec![Placed::hull(0, &icosahedron(6.0), at, rotation)];
    let tiling = Tiling::new(grid([13; 3], 2, [4; 3]), origin, placed);
    check_cells(&tiling, &all(&bench, &tiling), ROUNDING);
}

/// Error of the quadrature along the edges of a cell, and rounding.
const BALLS: f64 = 5e-6;

#[test]
fn balls() {
    let bench = Workbench::new(None);
    let mut noise = Random(3);
    let corner = DVec3::splat(0.5);
    let hardly_off = 0.5 + 1e-5 * (noise.point() - 0.5);
    let offsets = [DVec3::ZERO, corner, noise.point(), hardly_off];
    for (n, offset) in offsets.into_iter().enumerate() {
        // Smaller balls are caps at the faces, edges or corners of a cell; at 3 the rule changes.
        let radii = [0.5, 0.7, 0.8, 0.9, 1.3, 1.75, 2.999, 3.0, 5.0, 8.0];
        let ball =
            |radius: f64| Placed::ball(0, f64::from(radius as f32), DVec3::splat(9.0) + offset);
        let tiling = Tiling::new(grids(19)[n], [0; 3], radii.map(ball).into());
        let shares = all(&bench, &tiling);
        check_cells(&tiling, &shares, BALLS);
        let mut sums = [0.0; 10];
        for (tile, shares) in tiling.tiles.iter().zip(shares.chunks(tiling.workgroup())) {
            sums[tile.part as usize] += sum(shares);
        }
        for (radius, (found, placed)) in radii.iter().zip(sums.iter().zip(&tiling.placed)) {
            let error = found / placed.volume - 1.0;
            assert!(error.abs() < ROUNDING, "radius {radius}: {error:e}");
        }
    }
}

/// Surfaces that touch a side, an edge or a corner of a cell from either side, at the poles, between them, and anywhere.
#[test]
fn pieces_of_balls_of_any_size() {
    let bench = Workbench::new(None);
    let mut noise = Random(9);
    let origin = [-3, 70_000, -1_000_000];
    let mut placed = Vec::new();
    for radius in [4.1f32, 12.0, 33.3, 100.0, 250.7, 1000.0] {
        let radius = f64::from(radius);
        let mut ways = vec![
            DVec3::Z,
            DVec3::NEG_X,
            DVec3::new(0.0, 1.0, 1.0),
            DVec3::new(1.0, -1.0, 1.0),
            DVec3::new(1.0, 1e-4, -1e-4),
            // The axis is near, or slightly too far to count as near.
            DVec3::new(radius.sqrt(), -1.0, radius),
            DVec3::new(0.7, radius, -0.7 * radius.sqrt()),
        ];
        ways.extend((0..3).map(|_| rotation(&mut noise) * DVec3::X));
        for (n, way) in ways.into_iter().enumerate() {
            let place = if n % 2 == 0 {
                DVec3::splat(4.0)
            } else {
                3.0 + noise.point()
            };
            for over in [0.0, 1e-6, -1e-3] {
                let at = centre(origin) - 0.5 + place - (radius + over) * way.normalize();
                placed.push(Placed::ball(0, radius, at));
            }
        }
    }
    let tiling = Tiling::new(grid([8; 3], 1, [4; 3]), origin, placed);
    check_cells(&tiling, &all(&bench, &tiling), BALLS);
}

/// Cells cut by more faces than the exact rule handles.
#[test]
fn a_part_with_sixty_faces() {
    let bench = Workbench::new(None);
    let mut noise = Random(4);
    // At 1.2 cells most cells have dozens of cuts, at 8 none does.
    for (radius, most) in [(1.2, 2e-3), (3.0, 2e-4), (8.0, 2e-5)] {
        let shape = pebble(60, radius);
        assert_eq!(shape.faces().len(), 60);
        let at = DVec3::splat(10.0) + noise.point();
        let placed = vec![Placed::hull(0, &shape, at, rotation(&mut noise))];
        let volume = placed[0].volume;
        let tiling = Tiling::new(grid([21; 3], 1, [4; 3]), [0; 3], placed);
        let shares = all(&bench, &tiling);
        let error = sum(&shares) / volume - 1.0;
        assert!(error.abs() < most, "radius {radius}: {error:e}");
        check_cells(&tiling, &shares, ROUNDING);
    }
}

/// The corner of eight cubes inside a cell, in any orientation: together they fill each cell.
#[test]
fn eight_cubes_fill_what_they_share() {
    let bench = Workbench::new(None);
    let mut noise = Random(6);
    for rotation in rotations(4, &mut noise) {
        let middle = DVec3::splat(8.0) + noise.point();
        let cube = cuboid(6.0, 6.0, 6.0);
        let corner = |k: u32| {
            let side = |bit: u32| if k >> bit & 1 == 1 { 3.0 } else { -3.0 };
            let at = middle + rotation * DVec3::new(side(0), side(1), side(2));
            Placed::hull(k, &cube, at, rotation)
        };
        let placed: Vec<_> = (0..8).map(corner).collect();
        let tiling = Tiling::new(grid([17; 3], 1, [4; 3]), [0; 3], placed);
        let shares = all(&bench, &tiling);
        let mut sums = std::collections::HashMap::new();
        for (tile, shares) in tiling.tiles.iter().zip(shares.chunks(64)) {
            for (local, share) in shares.iter().enumerate() {
                if let Some(cell) = tiling.cell(tile, local) {
                    let (sum, parts) = sums.entry(cell).or_insert((0.0, 0));
                    *sum += fraction(*share);
                    *parts += u32::from(*share > 0.0);
                }
            }
        }
        // All cells inside the cube of the eight.
        let mut shared = 0;
        for (cell, (sum, parts)) in sums {
            let r: DVec3 = rotation.inverse() * (centre(cell) - middle);
            if r.abs().max_element() < 5.0 {
                assert!((sum - 1.0).abs() < 1e-5, "{cell:?}: {sum}");
                shared = shared.max(parts);
            }
        }
        // The cell of the corner, unless the corner is on its boundary.
        assert!(shared >= 4, "{shared}");
    }
}

#[test]
fn lists_of_any_length_and_fold() {
    let placed = vec![Placed::hull(
        0,
        &cuboid(7.0, 5.0, 6.0),
        DVec3::splat(8.3),
        DQuat::from_rotation_y(0.4),
    )];
    let tiling = Tiling::new(grid([17; 3], 2, [4; 3]), [0; 3], placed);
    let count = tiling.tiles.len() as u32;
    assert!(count > 30);
    let whole = all(&Workbench::new(None), &tiling);
    let listed = |shares: &[f32], tile: u32| {
        let range = 64 * tile as usize..64 * (tile as usize + 1);
        let written = shares[range.clone()] == whole[range.clone()];
        let poison = shares[range].iter().all(|s| s.to_bits() == POISON);
        assert!(written != poison, "tile {tile} is half written");
        written
    };
    // In rows of 7 with surplus groups.
    let folded = all(&Workbench::new(Some(7)), &tiling);
    assert!(folded == whole);
    let bench = Workbench::new(None);
    // Some tiles, in any order, with unused entries; more groups than jobs; no tile.
    let odd: Vec<u32> = (0..count).rev().filter(|n| n % 2 == 1).collect();
    let mut sparse = odd.clone();
    sparse.splice(3..3, [u32::MAX, u32::MAX]);
    let some = run(&bench, &tiling, &sparse);
    let mut short = odd[..5].to_vec();
    short.resize(odd.len(), u32::MAX);
    let first = run(&bench, &tiling, &short);
    let none = run(&bench, &tiling, &[u32::MAX]);
    for tile in 0..count {
        assert_eq!(listed(&some, tile), tile % 2 == 1);
        assert_eq!(listed(&first, tile), odd[..5].contains(&tile));
        assert!(!listed(&none, tile));
    }
}

/// A tile without a cell in the domain is all zero for any pose of the part.
#[test]
fn tiles_beyond_the_domain() {
    let placed = vec![Placed::ball(0, 6.0, DVec3::splat(4.0))];
    let mut tiling = Tiling::new(grid([8; 3], 1, [4; 3]), [0; 3], placed);
    for tile in &mut tiling.tiles {
        *tile = Tile {
            inside: Tile::pack([4, 0, 4]),
            ..*tile
        };
    }
    let shares = all(&Workbench::new(None), &tiling);
    assert!(shares.iter().all(|s| *s == 0.0));
}
