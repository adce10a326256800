//! Sections of blocks by a plane, and how they are drawn.

use super::fixture::{Rgb, file, read, slice};
use glam::{DMat3, DVec3};
use riprap::geometry::{Form, Polyhedron};
use riprap::output::{Array, ImageData};
use riprap_harness::picture::{Palette, Placed, Plane, Quantity};
use std::f64::consts::{FRAC_PI_4, PI};

/// A cube of 1 m at (1, 1, 0.75), rotated about z by 45°, and a ball of 0.5 m at its side.
fn cut_blocks() -> [(Form, DVec3, DMat3); 2] {
    let cube = Form::Convex(Polyhedron::cuboid(DVec3::ONE).expect("a cube"));
    let ball = Form::Sphere { radius: 0.5 };
    [
        (
            cube,
            DVec3::new(1.0, 1.0, 0.75),
            DMat3::from_rotation_z(FRAC_PI_4),
        ),
        (ball, DVec3::new(2.5, 1.0, 1.0), DMat3::IDENTITY),
    ]
}

fn placed((form, centre, deformation): &(Form, DVec3, DMat3)) -> Placed<'_> {
    Placed {
        form,
        centre: *centre,
        deformation: *deformation,
    }
}

#[test]
fn a_plane_cuts_the_polygon_of_a_cube_and_the_circle_of_a_ball() {
    let blocks = cut_blocks();
    let outline =
        |block: usize, normal, position| placed(&blocks[block]).outline(Plane { normal, position });
    // Across its edges the square of the cube, standing on a corner.
    let square = outline(0, 2, 0.6).expect("a cut");
    assert_eq!(square.len(), 4);
    for point in &square {
        let [x, y] = [point[0] - 1.0, point[1] - 1.0];
        assert!(
            (x.abs() + y.abs() - 0.5_f64.sqrt()).abs() < 1e-12,
            "{point:?}"
        );
    }
    // Along x through the middle: as wide as its diagonal, as high as an edge.
    let across = outline(0, 1, 1.0).expect("a cut");
    let wide = across.iter().map(|p| p[0]).fold(0.0, f64::max) - 1.0;
    assert!((wide - 0.5_f64.sqrt()).abs() < 1e-12, "{wide}");
    assert!(
        across
            .iter()
            .all(|p| ((p[1] - 0.75).abs() - 0.5).abs() < 1e-12)
    );
    assert_eq!(outline(0, 2, 1.3), None);
    // At 0.3 m from its middle a ball of 0.5 m is 0.4 m wide.
    let circle = outline(1, 2, 1.3).expect("a cut");
    for point in &circle {
        let radius = (point[0] - 2.5).hypot(point[1] - 1.0);
        assert!((radius - 0.4).abs() < 1e-12, "{radius}");
    }
    assert_eq!(outline(1, 0, 3.1), None);
    // Stretched to twice its width, it is an ellipse.
    let stretched = Placed {
        deformation: DMat3::from_diagonal(DVec3::new(2.0, 1.0, 1.0)),
        ..placed(&blocks[1])
    };
    let ellipse = stretched
        .outline(Plane {
            normal: 1,
            position: 1.3,
        })
        .expect("a cut");
    for point in &ellipse {
        let radius = (0.5 * (point[0] - 2.5)).hypot(point[1] - 1.0);
        assert!((radius - 0.4).abs() < 1e-12, "{radius}");
    }
}

#[test]
fn blocks_are_drawn_over_the_slice_and_their_cells_do_not_stretch_the_colours() {
    let cells = [30, 20, 1];
    let inside = |x: f64, y: f64| (x - 1.0).abs() + (y - 1.0).abs() < 0.5_f64.sqrt();
    let mut values = Vec::new();
    for j in 0..20 {
        for i in 0..30 {
            let [x, y] = [i, j].map(|n| 0.1 * (f64::from(n) + 0.5));
            values.push(if inside(x, y) { 1e6 } else { x as f32 });
        }
    }
    let image = ImageData {
        origin: [0.0, 0.0, 0.7],
        spacing: 0.1,
        cells,
        arrays: vec![
            // As written for a fluid with immersed blocks.
            Array {
                name: "solid".into(),
                components: 1,
                values: values.iter().map(|v| f32::from(*v == 1e6)).collect(),
            },
            Array {
                name: "pressure".into(),
                components: 1,
                values,
            },
        ],
    };
    let blocks = cut_blocks();
    let blocks: Vec<Placed<'_>> = blocks.iter().map(placed).collect();
    let path = file("blocks.png");
    let mut drawn = slice(Quantity::Scalar("pressure"), 2, 0.75);
    drawn.blocks = &blocks;
    drawn.draw(&image, &path).expect("a picture");
    let (width, _, pixels) = read(&path);
    let count = |rgb: Rgb| pixels.iter().filter(|p| **p == rgb).count() as f64;
    // The leftmost cells have the first colour and the rightmost the last one, both over all of 2 m.
    let [first, last] = [0.0, 1.0].map(|end| {
        let colour = Palette::Sequential.colour(end);
        [colour.0, colour.1, colour.2]
    });
    let [one, other] = [count(first), count(last)];
    assert!((one / other - 1.0).abs() < 0.05, "{one} {other}");
    let rows = (0..pixels.len()).filter(|at| pixels[*at] == first);
    let rows: Vec<usize> = rows.map(|at| at / width).collect();
    // Half of the border's line lies within on either side.
    let scale = 0.5 * (rows[rows.len() - 1] - rows[0] + 2) as f64;
    // A square of 1 m², and a disc of radius √(0.25 − 0.0625) m from the ball, whose outlines are one pixel inside.
    let radius = (0.25_f64 - 0.0625).sqrt();
    let covered = (1.0 + PI * radius * radius) * scale * scale;
    let outlines = (4.0 + 2.0 * PI * radius) * scale;
    let grey = count([120, 120, 120]) + outlines;
    assert!((grey / covered - 1.0).abs() < 0.02, "{grey} of {covered}");
}
