//! The fraction of a cell that decides the weight of the solid, in f64 (docs/src/theory/solids.md).

use crate::exact::{ball_fraction, hull_fraction};
use glam::DVec3;
use riprap::geometry::HalfSpace;

/// Of a polyhedron of which `solid` is in the cell about `r`: alone, and beside others.
pub fn effective_hull(faces: &[HalfSpace], r: DVec3, solid: f64) -> [f64; 2] {
    if solid <= 0.0 {
        return [0.0; 2];
    }
    // What rounding leaves out of a cell is nothing, of which the fourth root would be something.
    let left = |face: &HalfSpace| match hull_fraction(std::slice::from_ref(face), r) {
        left if left > 1.0 - 1e-12 => 1.0,
        left => left.max(1e-6),
    };
    let left: Vec<f64> = faces.iter().map(left).collect();
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
    let product: f64 = left.iter().product();
    [effective, left[least]].map(|e| e * (solid / product).sqrt().min(1.0))
}

/// Of parts that share a cell, each with its solid fraction and its effective ones.
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

/// Of a sphere whose radius grows by `growth` over it.
pub fn effective_ball(radius: f64, growth: f64, r: DVec3) -> f64 {
    let radius = radius + growth / radius.max(2.0);
    match (r.abs() + 0.5).length() <= radius {
        true => 1.0,
        false => ball_fraction(radius, r),
    }
}

/// In the notation of the docs: two planes at a right angle leave 1/4 and 3/4; a plane that leaves all counts as none.
#[test]
fn planes_at_right_angles() {
    let plane = |normal, distance| HalfSpace { normal, distance };
    let x = |left: f64| plane(DVec3::X, left - 0.5);
    let y = |left: f64| plane(DVec3::Y, left - 0.5);
    let of = |planes: [HalfSpace; 2], solid| effective_hull(&planes, DVec3::ZERO, solid);
    let [mean, least] = of([x(0.25), y(0.75)], 0.25 * 0.75);
    assert!((least - 0.25).abs() < 1e-12, "{least}");
    let [a, b] = [3f64.powf(0.25), 3f64.powf(-0.25)];
    let expected = (0.25 * a + 0.75 * b) / (a + b);
    assert!((mean - expected).abs() < 1e-12, "{mean}");
    for [alone, _] in [of([x(0.4), y(0.4)], 0.16), of([x(0.4), y(1.0)], 0.4)] {
        assert!((alone - 0.4).abs() < 1e-12, "{alone}");
    }
}

/// Boxes that are flush with each other leave what the plane of both does, wherever their joints are.
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
                parts.push((solid, effective_hull(&faces, DVec3::ZERO, solid)));
            }
        }
        let found = together(&parts);
        assert!((found - z).abs() < 1e-9, "{x} {y} {z}: {found}");
    }
}
