//! The effective solid fraction of a cell, from which the weight of the solid follows, in f64 (docs/src/theory/solids.md).

use crate::{
    exact::{polyhedron_fraction, sphere_fraction},
    shapes::{cuboid, icosahedron, pebble, tetrahedron},
    tiling::{Placed, Tiling, centre, grid, rotation},
    voxelise::{GROWTH, both, fraction},
};
use glam::{DQuat, DVec3};
use kit::{Random, Workbench};
use riprap::{geometry::HalfSpace, lattice::SolidWeight};

/// Effective fractions of a polyhedron with the fraction `solid` in the cell around `r`: alone, and next to other parts.
pub fn effective_polyhedron(faces: &[HalfSpace], r: DVec3, solid: f64) -> [f64; 2] {
    if solid <= 0.0 {
        return [0.0; 2];
    }
    // Rounding is removed, since its fourth root would not be small.
    let left = |face: HalfSpace| match polyhedron_fraction(&[face], r) {
        left if left > 1.0 - 1e-12 => 1.0,
        left => left.max(1e-6),
    };
    let product: f64 = faces.iter().map(|face| left(*face)).product();
    let left: Vec<f64> = faces.iter().map(|face| left(outside(face))).collect();
    let least = (0..left.len()).min_by(|a, b| left[*a].total_cmp(&left[*b]));
    let Some(least) = least else {
        return [solid; 2];
    };
    let root = |left: f64| ((1.0 - left) / left).max(0.0).powf(0.25);
    let own = root(left[least]);
    let mut effective = left[least];
    for (face, left_by) in faces.iter().zip(&left) {
        let steepness = 1.0 - face.normal.dot(faces[least].normal);
        let other = steepness.clamp(0.0, 1.0) * root(*left_by);
        if own + other > 0.0 {
            let mean = (own * left[least] + other * left_by) / (own + other);
            effective = effective.max(mean);
        }
    }
    [effective, left[least]].map(|e| e * (solid / product).sqrt().min(1.0))
}

/// The face for the weight: moved outwards by 0.05 (1 − Σn_a⁴) of a cell.
fn outside(face: &HalfSpace) -> HalfSpace {
    let n = face.normal;
    let shift = 0.05 * (1.0 - (n * n).dot(n * n));
    HalfSpace {
        distance: face.distance + shift,
        ..*face
    }
}

/// Effective fraction of parts that share a cell, each given by its solid fraction and its two effective fractions.
pub fn together(parts: &[(f64, [f64; 2])]) -> f64 {
    let parts: Vec<_> = parts
        .iter()
        .filter(|(_, [alone, _])| *alone > 0.0)
        .collect();
    let all: f64 = parts.iter().map(|(solid, _)| solid).sum();
    let each = parts.iter().map(|(solid, [alone, beside])| {
        if parts.len() == 1 {
            return *alone;
        }
        let longer = (solid / beside.max(1e-9)).min(*beside) - solid;
        let filled = (all - solid) / longer.max(1e-9);
        beside + (1.0 - filled).clamp(0.0, 1.0) * (alone - beside)
    });
    each.fold(all, f64::max).min(1.0)
}

/// Effective fraction of a sphere, whose radius grows by `growth` over the radius.
pub fn effective_sphere(radius: f64, growth: f64, r: DVec3) -> f64 {
    let radius = radius + growth / radius.max(2.0);
    match (r.abs() + 0.5).length() <= radius {
        true => 1.0,
        false => sphere_fraction(radius, r),
    }
}

/// In the notation of the docs: two planes at a right angle leave 1/4 and 3/4; a plane that cuts nothing off has no effect.
#[test]
fn planes_at_right_angles() {
    let plane = |normal, distance| HalfSpace { normal, distance };
    let x = |left: f64| plane(DVec3::X, left - 0.5);
    let y = |left: f64| plane(DVec3::Y, left - 0.5);
    let of = |planes: [HalfSpace; 2], solid| effective_polyhedron(&planes, DVec3::ZERO, solid);
    let [mean, least] = of([x(0.25), y(0.75)], 0.25 * 0.75);
    assert!((least - 0.25).abs() < 1e-12, "{least}");
    let [a, b] = [3f64.powf(0.25), 3f64.powf(-0.25)];
    let expected = (0.25 * a + 0.75 * b) / (a + b);
    assert!((mean - expected).abs() < 1e-12, "{mean}");
    for [alone, _] in [of([x(0.4), y(0.4)], 0.16), of([x(0.4), y(1.0)], 0.4)] {
        assert!((alone - 0.4).abs() < 1e-12, "{alone}");
    }
}

/// Flush boxes have the effective fraction of their common plane, independent of the position of their joints.
#[test]
fn flush_parts() {
    let plane = |normal, distance| HalfSpace { normal, distance };
    for (x, y, z) in [
        (0.5, 1.0, 0.3),
        (0.9, 1.0, 0.3),
        (0.1, 0.6, 0.7),
        (0.35, 0.8, 0.2),
    ] {
        let mut parts = Vec::new();
        for (left, of_x) in [(-1.0, 1.0 - x), (1.0, x)] {
            for (front, of_y) in [(-1.0, 1.0 - y), (1.0, y)] {
                let faces = [
                    plane(left * DVec3::X, of_x - 0.5),
                    plane(front * DVec3::Y, of_y - 0.5),
                    plane(DVec3::Z, z - 0.5),
                ];
                let solid = of_x * of_y * z;
                parts.push((solid, effective_polyhedron(&faces, DVec3::ZERO, solid)));
            }
        }
        let found = together(&parts);
        assert!((found - z).abs() < 1e-9, "{x} {y} {z}: {found}");
    }
}

/// Fourth roots of the complements of planes amplify rounding of 1e-7 to 0.02; there are few such cells.
#[test]
fn effective_fractions_of_edges_and_spheres() {
    let bench = Workbench::new(None);
    let mut noise = Random(12);
    let at = |noise: &mut Random| DVec3::splat(9.0) + noise.point();
    let mut placed: Vec<Placed> = [1.0, 2.5, 6.3]
        .into_iter()
        .map(|radius: f64| Placed::ball(0, f64::from(radius as f32), at(&mut noise)))
        .collect();
    let shapes = [
        cuboid(7.0, 5.0, 6.0),
        tetrahedron(9.0),
        icosahedron(4.0),
        pebble(60, 5.0),
    ];
    for shape in &shapes {
        for turn in [DQuat::IDENTITY, rotation(&mut noise)] {
            placed.push(Placed::hull(0, shape, at(&mut noise), turn));
        }
    }
    let tiling = Tiling::new(grid([20; 3], 1, [4; 3]), [0; 3], placed);
    let work: Vec<u32> = (0..tiling.tiles.len() as u32).collect();
    let [shares, effective] = both(&bench, &tiling, &work, SolidWeight::Exact);
    let (mut worst, mut sum, mut cells) = (0f64, 0.0, 0.0);
    for (number, tile) in tiling.tiles.iter().enumerate() {
        let placed = &tiling.placed[tile.part as usize];
        for local in 0..tiling.workgroup() {
            let Some(cell) = tiling.cell(tile, local) else {
                continue;
            };
            let r = centre(cell) - placed.centre;
            let place = number * tiling.workgroup() + local;
            let share = shares[place];
            let expected = match placed.faces.is_empty() {
                true => [effective_sphere(placed.radius, GROWTH, r); 2],
                false => effective_polyhedron(&placed.faces, r, fraction(share)),
            };
            for (found, expected) in effective[2 * place..].iter().zip(expected) {
                let found = f64::from(*found);
                assert!((0.0..=1.0).contains(&found), "{r}: {found}");
                // A cell that counts has a share or a mark.
                assert!(share != 0.0 || found == 0.0, "{r}: {found}");
                let error = (found - expected).abs();
                if expected > 0.0 && expected < 1.0 {
                    (worst, sum, cells) = (worst.max(error), sum + error, cells + 1.0);
                } else {
                    assert!(error < 1e-4, "{r}: {found}, {expected}");
                }
            }
        }
    }
    assert!(
        worst < 0.02 && sum / cells < 1e-4,
        "{worst} {}",
        sum / cells
    );
    assert!(cells > 1000.0, "{cells}");
}
