//! Shells where the parts of a compound meet.

use crate::{DX, Made, nearest, scene};
use glam::{DVec2, DVec3};

/// Two corners of a rectangle of a section, x and z, m.
type Rectangle = [[f64; 2]; 2];

/// A section with re-entrant corners: its name, its parts and the outline of all of them, m.
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

/// A compound of boxes across a plane, `scale` times the size.
fn compound(parts: &[Rectangle], scale: f64, keys: &str) -> Made {
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
    Made::of(&scene("plane = true", &block).unwrap())
}

/// How far some point of the first two layers below `outline` is from all shell points of block `b`, m.
fn widest_hole(made: &Made, parts: &[Rectangle], outline: &[[f64; 2]], scale: f64) -> f64 {
    let index = made.block("b");
    // Shells are about the centroid, which the first part tells.
    let [low, high] = parts[0].map(|x| DVec2::from(x) * scale);
    let offset = made.setup.setup.blocks[index].shape.parts()[0].offset;
    let origin = DVec2::new(offset.x, offset.z) - low.midpoint(high);
    let shell = made.shells[index]
        .iter()
        .map(|x| DVec2::new(x.x, x.z) - origin);
    let shell: Vec<DVec2> = shell.collect();
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
                    let distances = shell.iter().map(|s| s.distance(x));
                    widest = widest.max(distances.fold(f64::INFINITY, f64::min));
                }
            }
        }
    }
    widest
}

/// Δx does not divide most of the sizes. In the square lattice nowhere is farther from a point than 0.71 Δx, and the
/// few rows over the parts' widths stretch by up to a tenth, or meet those of another part.
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
                let made = compound(&parts, scale, &keys);
                let widest = widest_hole(&made, &parts, &outline, scale) / DX;
                assert!(
                    widest < 0.8,
                    "{name} × {scale}, {motion}: {widest} spacings"
                );
                let apart = nearest(&made.shell("b")) / DX;
                assert!(apart > 0.599, "{name} × {scale}, {motion}: {apart}");
            }
        }
    }
}

/// A box on a plate, in space: around its foot no hole is wider than half a diagonal of the lattice's cube and the
/// tenth by which rows stretch.
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
        let made = Made::of(&scene("", &block).unwrap());
        let index = made.block("b");
        // The plate's centre is the origin.
        let offset = made.setup.setup.blocks[index].shape.parts()[0].offset;
        let shell: Vec<DVec3> = made.shells[index].iter().map(|x| *x - offset).collect();
        let mut widest = 0.0f64;
        for n in 0..=40 {
            let along = (f64::from(n) / 40.0 - 0.5) * (foot - DX);
            for layer in [0.5, 1.0, 1.5] {
                for up in -6..=12 {
                    let side = 0.5 * foot - layer * DX;
                    let z = 0.1 + 0.25 * f64::from(up) * DX;
                    for x in [DVec3::new(side, along, z), DVec3::new(along, -side, z)] {
                        let distances = shell.iter().map(|s| s.distance(x));
                        widest = widest.max(distances.fold(f64::INFINITY, f64::min));
                    }
                }
            }
        }
        let widest = widest / DX;
        assert!(widest < 0.95, "× {scale}: {widest} spacings");
    }
}
