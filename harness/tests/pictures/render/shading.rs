//! Light, shadow, edges and colours on bodies.

use super::fixture::{
    body, body_in_the_middle_row, drawing, level, linear, oblique, pixel_at, plain_cube, render,
    seen, speed,
};
use glam::DVec3;
use riprap::geometry::Polyhedron;
use riprap::wgpu::naga;
use riprap_harness::picture::Palette;
use riprap_harness::render::{Camera, Drawing, Ground, Instance, Mesh, SHADERS};

#[test]
fn shaders_are_valid() {
    for (name, text) in SHADERS {
        let module = naga::front::wgsl::parse_str(text)
            .unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(text)));
        let flags = naga::valid::ValidationFlags::all();
        naga::valid::Validator::new(flags, naga::valid::Capabilities::empty())
            .validate(&module)
            .unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(text)));
    }
}

#[test]
fn shaded_colours_keep_the_ratios_of_the_colour_map() {
    let meshes = [plain_cube()];
    let size = [420, 200];
    for value in [0.0, 0.35, 0.7, 1.0] {
        let coloured = Instance {
            value: Some(value),
            ..body(DVec3::ZERO)
        };
        let drawing = Drawing {
            colours: speed([0.0, 1.0]),
            ..drawing(&meshes, vec![coloured], level())
        };
        let picture = render(&drawing, size);
        let [x, y] = body_in_the_middle_row(&picture);
        let drawn = picture.pixel(x, y).map(linear);
        let map = Palette::FromPale.colour(value);
        let map = [map.0, map.1, map.2].map(linear);
        let light = drawn.iter().sum::<f64>() / map.iter().sum::<f64>();
        assert!(light > 0.3 && light < 1.02, "light {light}");
        for (drawn, map) in drawn.iter().zip(map) {
            // Half a step of 8 bits either way is at most 0.0045 in linear light.
            assert!(
                (drawn - light * map).abs() < 0.009,
                "{value}: {drawn} of {map}"
            );
        }
        // The colour bar has the exact colour, to the right of the body.
        let exact = Palette::FromPale.colour(0.5);
        let exact = [exact.0, exact.1, exact.2];
        let near = |p: [u8; 3]| exact.iter().zip(p).all(|(a, b)| a.abs_diff(b) <= 2);
        let bar =
            (x..picture.width).any(|x| (0..picture.height).any(|y| near(picture.pixel(x, y))));
        assert!(bar, "no colour bar");
    }
}

#[test]
fn fixed_blocks_are_grey() {
    let meshes = [plain_cube()];
    let drawing = drawing(
        &meshes,
        vec![Instance {
            value: Some(1.0),
            fixed: true,
            ..body(DVec3::ZERO)
        }],
        level(),
    );
    let [r, g, b] = render(&drawing, [120, 90]).pixel(60, 45);
    assert!(r == g && g == b && r < 255, "{r} {g} {b}");
}

#[test]
fn the_three_visible_faces_of_a_cube_differ() {
    let size = [240, 180];
    let meshes = [plain_cube()];
    let drawing = drawing(&meshes, vec![body(DVec3::ZERO)], oblique());
    let picture = render(&drawing, size);
    let shades = [DVec3::X, -DVec3::Y, DVec3::Z]
        .map(|normal| pixel_at(&picture, seen(&oblique(), size, 0.5 * normal))[0]);
    for (a, b) in [(0, 1), (1, 2), (2, 0)] {
        assert!(shades[a].abs_diff(shades[b]) > 12, "shades {shades:?}");
    }
    assert_eq!(
        shades.iter().max(),
        Some(&shades[2]),
        "the top is the lightest"
    );
}

#[test]
fn edges_are_drawn_dark() {
    let size = [240, 180];
    let cube = Mesh::of(&Polyhedron::cuboid(DVec3::ONE).expect("a cube"));
    assert_eq!(cube.edges.len(), 12);
    let meshes = [cube];
    let drawing = drawing(&meshes, vec![body(DVec3::ZERO)], oblique());
    let picture = render(&drawing, size);
    // The edge between the front and the top.
    let [x, y] = seen(&oblique(), size, DVec3::new(0.0, -0.5, 0.5)).map(|place| place as u32);
    let across = (y - 3..=y + 3).map(|y| picture.pixel(x, y)[0]);
    let face = pixel_at(&picture, seen(&oblique(), size, DVec3::new(0.0, -0.5, 0.0)))[0];
    assert!(across.min() < Some(face / 4 * 3), "face {face}");
}

#[test]
fn a_block_throws_its_shadow_away_from_the_sun() {
    let size = [240, 180];
    let meshes = [plain_cube()];
    let camera = Camera {
        field_of_view: 30_f64.to_radians(),
        ..oblique()
    };
    let drawing = Drawing {
        ground: Some(Ground { height: 0.0 }),
        sun: Some(DVec3::new(1.0, 0.0, 1.0)),
        ..drawing(&meshes, vec![body(DVec3::new(0.0, 0.0, 1.0))], camera)
    };
    let picture = render(&drawing, size);
    // Between the lines of the grid.
    let spot = |x: f64| pixel_at(&picture, seen(&camera, size, DVec3::new(x, 0.07, 0.0)))[0];
    assert!(spot(1.07) > 200, "open ground {}", spot(1.07));
    assert!(spot(-1.07) < 190, "shadow {}", spot(-1.07));
}
