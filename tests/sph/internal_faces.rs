//! Boundary particles at the internal faces of compounds.

use crate::start::{DX, Initial, distance_to_nearest, least_distance, scene};
use glam::{DVec2, DVec3};

/// Two corners of a rectangle of a section, x and z, m.
type Rectangle = [[f64; 2]; 2];

/// A section with re-entrant corners: name, parts and outline, m.
type Section = (&'static str, Vec<Rectangle>, Vec<[f64; 2]>);

fn sections() -> [Section; 4] {
    let l = vec![
        [0.0, 0.0],
        [0.6, 0.0],
        [0.6, 0.25],
        [0.25, 0.25],
        [0.25, 0.6],
        [0.0, 0.6],
    ];
    [
        (
            "L",
            vec![[[0.0, 0.0], [0.6, 0.25]], [[0.0, 0.25], [0.25, 0.6]]],
            l.clone(),
        ),
        (
            "L of three parts",
            vec![
                [[0.0, 0.0], [0.25, 0.25]],
                [[0.25, 0.0], [0.6, 0.25]],
                [[0.0, 0.25], [0.25, 0.6]],
            ],
            l,
        ),
        (
            "U",
            vec![
                [[0.0, 0.0], [1.0, 0.2]],
                [[0.0, 0.2], [0.2, 0.6]],
                [[0.8, 0.2], [1.0, 0.6]],
            ],
            vec![
                [0.0, 0.0],
                [1.0, 0.0],
                [1.0, 0.6],
                [0.8, 0.6],
                [0.8, 0.2],
                [0.2, 0.2],
                [0.2, 0.6],
                [0.0, 0.6],
            ],
        ),
        (
            "T",
            vec![[[0.0, 0.0], [0.8, 0.2]], [[0.3, 0.2], [0.55, 0.6]]],
            vec![
                [0.0, 0.0],
                [0.8, 0.0],
                [0.8, 0.2],
                [0.55, 0.2],
                [0.55, 0.6],
                [0.3, 0.6],
                [0.3, 0.2],
                [0.0, 0.2],
            ],
        ),
    ]
}

/// Distance of a point from a line from `a` to `b`, m.
fn from_line(x: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = ((x - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
    x.distance(a.lerp(b, along))
}

/// A compound of boxes in a planar scene, scaled by `scale`.
fn compound(parts: &[Rectangle], scale: f64, keys: &str) -> Initial {
    let part = |[low, high]: &Rectangle| {
        let [low, high] = [*low, *high].map(|x| DVec2::from(x) * scale);
        let (size, middle) = (high - low, low.midpoint(high));
        format!(
            "{{ kind = \"box\", size = [{}, 1.0, {}], position = [{}, 0, {}] }}",
            size.x, size.y, middle.x, middle.y
        )
    };
    let parts: Vec<String> = parts.iter().map(part).collect();
    let block = format!(
        "[[blocks]]\nname = \"b\"\nkind = \"compound\"\nparts = [{}]\n{keys}\n",
        parts.join(", ")
    );
    Initial::of(&scene("plane = true", &block).unwrap())
}

/// Largest distance of a point in the first two layers below `outline` from all boundary particles of block `b`, m.
fn widest_hole(initial: &Initial, parts: &[Rectangle], outline: &[[f64; 2]], scale: f64) -> f64 {
    let index = initial.block("b");
    // Boundary particles are relative to the centroid, which follows from the first part.
    let [low, high] = parts[0].map(|x| DVec2::from(x) * scale);
    let offset = initial.setup.setup.blocks[index].shape.parts()[0].offset;
    let origin = DVec2::new(offset.x, offset.z) - low.midpoint(high);
    let boundary = initial.boundary[index]
        .iter()
        .map(|x| DVec2::new(x.x, x.z) - origin);
    let boundary: Vec<DVec2> = boundary.collect();
    let ring: Vec<DVec2> = outline.iter().map(|x| DVec2::from(*x) * scale).collect();
    let depth = |x: DVec2| {
        let ends = ring.iter().cycle().skip(1);
        let lines = ring.iter().zip(ends).map(|(a, b)| from_line(x, *a, *b));
        lines.fold(f64::INFINITY, f64::min)
    };
    let step = DX / 8.0;
    let mut widest = 0.0f64;
    for [low, high] in parts {
        let [low, high] = [*low, *high].map(|x| DVec2::from(x) * scale);
        let count = ((high - low) / step).floor();
        for i in 0..=count.x as u32 {
            for k in 0..=count.y as u32 {
                let x = low + DVec2::new(f64::from(i), f64::from(k)) * step;
                let layers = 0.5 * DX..=1.5 * DX;
                if layers.contains(&depth(x)) {
                    let distances = boundary.iter().map(|s| s.distance(x));
                    widest = widest.max(distances.fold(f64::INFINITY, f64::min));
                }
            }
        }
    }
    widest
}

/// Δx does not divide most of the sizes. In a square lattice no point is farther than 0.71 Δx from a particle; the few
/// rows across a part stretch by up to a tenth, or meet those of another part.
#[test]
fn re_entrant_corners_of_a_compound_have_no_holes() {
    for (name, parts, outline) in sections() {
        for scale in [1.0, 1.03, 1.08, 1.13, 1.17, 1.21, 0.94] {
            for motion in [
                "\"fixed\"",
                "\"free\"",
                "\"driven\"\nrotation = { axis = [0, 1, 0], angle = -25 }",
            ] {
                let keys = format!("position = [0.4, 0.5, 0.2]\nmotion = {motion}");
                let initial = compound(&parts, scale, &keys);
                let widest = widest_hole(&initial, &parts, &outline, scale) / DX;
                assert!(
                    widest < 0.8,
                    "{name} × {scale}, {motion}: {widest} spacings"
                );
                let apart = least_distance(&initial.boundary_of("b")) / DX;
                assert!(apart > 0.599, "{name} × {scale}, {motion}: {apart}");
            }
        }
    }
}

/// A box on a plate in three dimensions: no hole around its foot is wider than half the diagonal of a lattice cube plus
/// the tenth by which rows stretch.
#[test]
fn the_foot_of_a_box_on_a_plate_has_no_holes() {
    for scale in [1.0, 1.04, 1.09] {
        let (plate, foot, height) = (0.7 * scale, 0.4 * scale, 0.3 * scale);
        let block = format!(
            "[[blocks]]\nname = \"b\"\nkind = \"compound\"\nposition = [1, 0.5, 0.6]\n\
             parts = [{{ kind = \"box\", size = [{plate}, {plate}, 0.2] }}, \
             {{ kind = \"box\", size = [{foot}, {foot}, {height}], position = [0, 0, {}] }}]\n",
            0.1 + 0.5 * height
        );
        let initial = Initial::of(&scene("", &block).unwrap());
        let index = initial.block("b");
        // The plate's centre is the origin.
        let offset = initial.setup.setup.blocks[index].shape.parts()[0].offset;
        let boundary: Vec<DVec3> = initial.boundary[index]
            .iter()
            .map(|x| *x - offset)
            .collect();
        let mut widest = 0.0f64;
        for n in 0..=40 {
            let along = (f64::from(n) / 40.0 - 0.5) * (foot - DX);
            for layer in [0.5, 1.0, 1.5] {
                for up in -6..=12 {
                    let side = 0.5 * foot - layer * DX;
                    let z = 0.1 + 0.25 * f64::from(up) * DX;
                    for x in [DVec3::new(side, along, z), DVec3::new(along, -side, z)] {
                        widest = widest.max(distance_to_nearest(x, &boundary));
                    }
                }
            }
        }
        let widest = widest / DX;
        assert!(widest < 0.95, "× {scale}: {widest} spacings");
    }
}
