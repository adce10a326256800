//! Streamlines follow the flow, are evenly spaced, and stay in the fluid.

use riprap::output::{Array, ImageData};
use riprap_harness::picture::{Plane, Quantity, Section, streamlines};
use std::f64::consts::TAU;

/// Vortices with the stream function ψ = sin x sin y on `cells`² cells, 2π m wide, with a solid
/// square.
fn vortices(cells: usize) -> Section {
    let spacing = TAU / cells as f64;
    let (mut velocity, mut solid) = (Vec::new(), Vec::new());
    for j in 0..cells {
        for i in 0..cells {
            let [x, y] = [i, j].map(|index| (index as f64 + 0.5) * spacing);
            velocity.extend([(x.sin() * y.cos()) as f32, (-x.cos() * y.sin()) as f32, 0.0]);
            solid.push(f32::from(
                (2.0..3.0).contains(&x) && (1.0..2.0).contains(&y),
            ));
        }
    }
    let image = ImageData {
        origin: [0.0; 3],
        spacing,
        cells: [cells, cells, 1],
        arrays: vec![
            Array {
                name: "velocity".into(),
                components: 3,
                values: velocity,
            },
            Array {
                name: "solid".into(),
                components: 1,
                values: solid,
            },
        ],
    };
    let plane = Plane {
        normal: 2,
        position: 0.0,
    };
    Section::new(&image, plane, Quantity::Magnitude("velocity")).expect("a section")
}

#[test]
fn streamlines_follow_the_flow_apart_from_each_other_and_from_solids() {
    let section = vortices(96);
    let separation = TAU / 30.0;
    let lines = streamlines(&section, separation);
    // Four vortices of half the width, each with a radius of some seven separations.
    assert!((15..80).contains(&lines.len()), "{} lines", lines.len());
    for (number, line) in lines.iter().enumerate() {
        let psi = |[x, y]: [f64; 2]| x.sin() * y.sin();
        let [x, y] = line[line.len() / 2];
        let mean = psi([x, y]);
        for &point in line {
            let cell = section.cell(point).expect("a point in the domain");
            assert!(!section.solid[cell], "a line in the solid at {point:?}");
            // The error of bilinear velocity is h²/8 |u''| = 5e-4, which accumulates over one period.
            assert!(
                (psi(point) - mean).abs() < 0.02,
                "ψ from {mean} to {}",
                psi(point)
            );
            let others = lines[..number].iter().flatten();
            let nearest = others.map(|other| (other[0] - point[0]).hypot(other[1] - point[1]));
            let nearest = nearest.fold(f64::INFINITY, f64::min);
            assert!(nearest >= 0.5 * separation, "lines {nearest} m apart");
        }
    }
    // No fluid cell is farther from a line than the distance at which lines begin, plus half of the longest line that was
    // too short to keep.
    let far = |point: [f64; 2]| {
        let distance = |other: &[f64; 2]| (other[0] - point[0]).hypot(other[1] - point[1]);
        lines
            .iter()
            .flatten()
            .map(distance)
            .fold(f64::INFINITY, f64::min)
    };
    for i in 0..30 {
        for j in 0..30 {
            let point = [i, j].map(|index| (f64::from(index) + 0.5) * TAU / 30.0);
            let solid = section.cell(point).is_none_or(|cell| section.solid[cell]);
            assert!(
                solid || far(point) < 2.5 * separation,
                "a hole at {point:?}"
            );
        }
    }
}
