//! Planes through a fluid and its streamlines, among blocks.

use super::fixture::{
    WHITE, body, drawing, level, linear, oblique, pixel_at, plain_cube, render, seen, speed,
};
use glam::DVec3;
use riprap_harness::picture::{Palette, Plane, Trace};
use riprap_harness::render::{Camera, Colours, Drawing, FluidPlane, Traces, View};

fn pressure(range: [f64; 2]) -> Colours {
    Colours {
        label: "pressure".into(),
        unit: "Pa".into(),
        range: Some(range),
    }
}

/// 4 × 2 cells of 0.5 m around the origin in the plane y = `position`, with the values 0, 1, ….
fn counting(position: f64) -> FluidPlane {
    FluidPlane {
        plane: Plane {
            normal: 1,
            position,
        },
        origin: [-1.0, -0.5],
        spacing: 0.5,
        cells: [4, 2],
        values: (0..8).map(|value| value as f32).collect(),
        colours: pressure([0.0, 8.0]),
    }
}

fn viridis(fraction: f64) -> [u8; 3] {
    let colour = Palette::Sequential.colour(fraction);
    [colour.0, colour.1, colour.2]
}

/// The camera of a drawing without title and bars in pictures of `SIZE`.
const SIZE: [u32; 2] = [640, 240];

/// Width of the view next to a picture's colour bars.
fn view_width(drawing: &Drawing<'_>) -> u32 {
    let sky = Drawing {
        background: riprap_harness::render::Background::Sky,
        ..drawing.clone()
    };
    let picture = render(&sky, SIZE);
    (0..SIZE[0])
        .find(|&x| picture.pixel(x, 0) == WHITE)
        .unwrap_or(SIZE[0])
}

#[test]
fn cells_of_a_plane_are_where_the_camera_sees_them_in_the_colours_of_the_bar() {
    let mut plane = counting(0.3);
    plane.values[5] = f32::NAN;
    let drawing = |camera| Drawing {
        planes: vec![plane.clone()],
        view: View::From(camera),
        ..Drawing::default()
    };
    for camera in [level(), oblique()] {
        let drawing = drawing(camera);
        let width = view_width(&drawing);
        let picture = render(&drawing, SIZE);
        for cell in 0..8_u32 {
            let [u, v] = [cell % 4, cell / 4].map(|n| 0.5 * (f64::from(n) + 0.5));
            let centre = DVec3::new(u - 1.0, 0.3, v - 0.5);
            let found = pixel_at(&picture, seen(&camera, [width, SIZE[1]], centre));
            let wants = match cell {
                5 => WHITE,
                _ => viridis(f64::from(cell) / 8.0),
            };
            assert_eq!(found, wants, "cell {cell}");
        }
    }
}

#[test]
fn a_block_is_seen_before_its_plane_and_not_behind_it() {
    let meshes = [plain_cube()];
    let with = |y: f64| {
        let mut plane = counting(0.0);
        plane.values = vec![4.0; 8];
        let drawing = Drawing {
            planes: vec![plane],
            ..drawing(&meshes, vec![body(DVec3::new(0.0, y, 0.0))], level())
        };
        let width = view_width(&drawing);
        let picture = render(&drawing, SIZE);
        let at = |x: f64| {
            pixel_at(
                &picture,
                seen(&level(), [width, SIZE[1]], DVec3::new(x, 0.0, 0.1)),
            )
        };
        [at(0.1), at(0.8)]
    };
    let water = viridis(0.5);
    let [behind, beside] = with(0.7);
    assert_eq!((behind, beside), (water, water));
    for y in [-0.7, 0.0] {
        let [block, beside] = with(y);
        assert_eq!(beside, water);
        // Sandstone is redder than blue.
        assert!(block[0] > block[2] && block != water, "{block:?} at {y}");
    }
}

#[test]
fn a_plane_of_cells_finer_than_pixels_has_their_mean_light() {
    let side = 1024;
    let checks = (0..side * side).map(|cell| ((cell % side + cell / side) % 2) as f32);
    let plane = FluidPlane {
        origin: [-0.5; 2],
        spacing: 1.0 / side as f64,
        cells: [side; 2],
        values: checks.collect(),
        colours: pressure([0.0, 1.0]),
        ..counting(0.0)
    };
    let drawing = Drawing {
        planes: vec![plane],
        view: View::From(level()),
        ..Drawing::default()
    };
    let picture = render(&drawing, SIZE);
    let width = view_width(&drawing);
    let found = pixel_at(&picture, [f64::from(width / 2), f64::from(SIZE[1] / 2)]);
    let ends = [viridis(0.0), viridis(1.0)];
    for channel in 0..3 {
        let mean = 0.5 * (linear(ends[0][channel]) + linear(ends[1][channel]));
        // A step of 8 bits is at most 0.01 of linear light, and each mip level has rounded once.
        assert!((linear(found[channel]) - mean).abs() < 0.02, "{found:?}");
    }
}

#[test]
fn planes_of_one_quantity_share_a_bar_and_others_have_their_own() {
    let width = |planes: Vec<FluidPlane>, coloured: bool| {
        view_width(&Drawing {
            planes,
            colours: coloured.then(|| speed([0.0, 1.0])).flatten(),
            view: View::From(level()),
            ..Drawing::default()
        })
    };
    let other = FluidPlane {
        colours: Colours {
            label: "density".into(),
            ..pressure([0.0, 8.0])
        },
        ..counting(0.5)
    };
    let [none, one, two] = [
        width(vec![], false),
        width(vec![counting(0.0)], false),
        width(vec![counting(0.0), other], false),
    ];
    assert_eq!(none, SIZE[0]);
    assert!(one < none && two < one);
    assert_eq!(width(vec![counting(0.0), counting(1.0)], false), one);
    assert!(width(vec![counting(0.0)], true) < one);
}

#[test]
fn a_trace_has_its_speeds_colours_between_dark_rims() {
    // From x = −1 m to 1 m, from 0 to 1 m/s.
    let place = |n: i32| DVec3::new(f64::from(n) / 40.0 - 1.0, 0.0, 0.02);
    let drawing = Drawing {
        traces: Some(Traces {
            lines: vec![Trace {
                speeds: (0..=80).map(|n| f64::from(n) / 80.0).collect(),
                points: (0..=80).map(place).collect(),
            }],
            colours: Colours {
                label: "speed".into(),
                unit: "m/s".into(),
                range: Some([0.0, 1.0]),
            },
        }),
        view: View::From(level()),
        ..Drawing::default()
    };
    let width = view_width(&drawing);
    let picture = render(&drawing, SIZE);
    let rows_at = |segment: i32| {
        let middle = 0.5 * (place(segment) + place(segment + 1));
        let [x, y] = seen(&level(), [width, SIZE[1]], middle).map(|at| at as u32);
        let rows: Vec<[u8; 3]> = (y - 9..y + 9).map(|y| picture.pixel(x, y)).collect();
        let drawn = rows.iter().filter(|row| **row != WHITE).count();
        (rows, drawn)
    };
    // The arrow head of 20 pixels is in the middle, and a metre has 91 pixels here.
    assert!(rows_at(36).1 > 10);
    for segment in (2..30).chain(48..78) {
        let (column, drawn) = rows_at(segment);
        assert!((4..=6).contains(&drawn), "{drawn} rows");
        let wants = viridis((f64::from(segment) + 0.5) / 80.0);
        // Segments are two pixels long and overlap with their neighbours: a pixel has one of three colours, or a mean of them.
        let three = [-1.0, 0.0, 1.0].map(|by| viridis((f64::from(segment) + 0.5 + by) / 80.0));
        let near = |p: &[u8; 3]| {
            (0..3).all(|channel| {
                let ends = three.map(|colour| colour[channel]);
                let low = ends.into_iter().min().unwrap_or(0).saturating_sub(1);
                let high = ends.into_iter().max().unwrap_or(0).saturating_add(1);
                (low..=high).contains(&p[channel])
            })
        };
        let found = (0..column.len()).filter(|row| near(&column[*row]));
        let found: Vec<usize> = found.collect();
        assert!(!found.is_empty(), "{wants:?} is not in {column:?}");
        let (first, last) = (found[0], found[found.len() - 1]);
        // On either side, a row that is at least partly rim.
        for side in [first - 1, last + 1] {
            let rim = linear(column[side][1]) / linear(wants[1]);
            assert!(rim < 0.7, "{rim} of {column:?}");
        }
    }
}

#[test]
fn a_plane_before_all_bodies_is_not_cut_off() {
    let meshes = [plain_cube()];
    let near = Camera {
        from: DVec3::new(0.0, -10.0, 0.0),
        ..level()
    };
    let drawing = Drawing {
        planes: vec![counting(-9.0)],
        ..drawing(&meshes, vec![body(DVec3::ZERO)], near)
    };
    let width = view_width(&drawing);
    let picture = render(&drawing, SIZE);
    let [x, y] = seen(&near, [width, SIZE[1]], DVec3::new(0.1, -9.0, 0.1));
    assert_eq!(pixel_at(&picture, [x, y]), viridis(6.0 / 8.0));
}
