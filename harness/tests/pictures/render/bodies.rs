//! Bodies and lines are where the camera sees them, and nearer ones hide farther ones.

use super::fixture::{
    WHITE, body, body_in_the_middle_row, extent, level, oblique, plain_cube, render, seen, speed,
};
use glam::{DMat3, DQuat, DVec3};
use riprap::geometry::Polyhedron;
use riprap_harness::render::{Camera, Drawing, Instance, Line, Mesh, View};

/// Area of the convex hull, by Andrew's monotone chain.
fn hull_area(mut points: Vec<[f64; 2]>) -> f64 {
    points.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
    let half = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..] {
                if (b[0] - a[0]) * (p[1] - a[1]) > (b[1] - a[1]) * (p[0] - a[0]) {
                    break;
                }
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut hull = half(&mut points.iter().copied());
    hull.extend(half(&mut points.iter().rev().copied()));
    let next = hull.iter().cycle().skip(1);
    let twice: f64 = hull
        .iter()
        .zip(next)
        .map(|(a, b)| a[0] * b[1] - a[1] * b[0])
        .sum();
    0.5 * twice.abs()
}

#[test]
fn a_cube_covers_what_a_pinhole_camera_sees_of_it() {
    let size = [480, 360];
    let meshes = [plain_cube()];
    let turn = DQuat::from_rotation_z(0.3) * DQuat::from_rotation_x(0.2);
    let centre = DVec3::new(0.2, 0.5, -0.1);
    for camera in [level(), oblique()] {
        let cube = Instance {
            deformation: DMat3::from_quat(turn),
            ..body(centre)
        };
        let drawing = Drawing {
            meshes: &meshes,
            instances: vec![cube],
            view: View::From(camera),
            ..Drawing::default()
        };
        let picture = render(&drawing, size);
        let pixels = picture
            .rgba
            .chunks(4)
            .filter(|rgba| rgba[..3] != WHITE)
            .count() as f64;
        let corners = meshes[0].vertices.iter();
        let corners = corners.map(|v| seen(&camera, size, centre + turn * v.position));
        let area = hull_area(corners.collect());
        // Pixels that are covered in part count whole: half a pixel along an outline of 4 √area.
        assert!((pixels / area - 1.0).abs() < 0.02, "{pixels} of {area}");
    }
}

#[test]
fn the_nearer_block_hides_the_farther_in_any_order() {
    let size = [420, 90];
    let meshes = [plain_cube()];
    let block = |y: f64, value: f64| Instance {
        value: Some(value),
        ..body(DVec3::new(0.0, y, 0.0))
    };
    let colour = |instances: Vec<Instance>| {
        let drawing = Drawing {
            meshes: &meshes,
            instances,
            view: View::From(level()),
            colours: speed([0.0, 1.0]),
            ..Drawing::default()
        };
        let picture = render(&drawing, size);
        let [x, y] = body_in_the_middle_row(&picture);
        picture.pixel(x, y)
    };
    let [slow, fast] = [0.1, 0.9].map(|value| colour(vec![block(-1.0, value)]));
    assert_ne!(slow, fast);
    for order in [[0, 1], [1, 0]] {
        let both = [block(-1.0, 0.1), block(2.0, 0.9)];
        let bodies = order.map(|index| both[index]).to_vec();
        assert_eq!(colour(bodies), slow, "order {order:?}");
    }
}

#[test]
fn meshes_drawn_together_look_like_meshes_with_many_instances() {
    let size = [160, 120];
    let shared = [Mesh::of(&Polyhedron::cuboid(DVec3::ONE).expect("a cube"))];
    let copies = vec![shared[0].clone(); 12];
    let instances = |distinct: bool| -> Vec<Instance> {
        let place = |index: usize| DVec3::new((index % 4) as f64, 0.0, (index / 4) as f64) * 1.3;
        let bodies = (0..12).map(|index| Instance {
            mesh: if distinct { index } else { 0 },
            // Stretched as well as turned: normals must turn with the surface.
            deformation: DMat3::from_diagonal(DVec3::new(1.0, 0.6, 0.8))
                * DMat3::from_rotation_x(index as f64),
            value: Some(index as f64),
            ..body(place(index))
        });
        bodies.collect()
    };
    let [one, many] = [(&shared[..], false), (&copies[..], true)].map(|(meshes, distinct)| {
        let drawing = Drawing {
            meshes,
            instances: instances(distinct),
            ..Drawing::default()
        };
        render(&drawing, size)
    });
    // Rounding may decide a sample of an outline otherwise.
    let far = one
        .rgba
        .iter()
        .zip(&many.rgba)
        .filter(|(a, b)| a.abs_diff(**b) > 3);
    let far = far.count();
    assert!(far < one.rgba.len() / 500, "{far} channels differ");
    assert_ne!(extent(&one)[0], [u32::MAX, 0]);
}

#[test]
fn far_from_the_origin_a_picture_is_the_same() {
    let size = [160, 120];
    let meshes = [Mesh::of(&Polyhedron::cuboid(DVec3::ONE).expect("a cube"))];
    // Places in eighths of a metre are exact in f64 at both ends, and not in f32 at the far one.
    let [here, there] = [DVec3::ZERO, DVec3::new(3e8, -5e8, 1e8)].map(|origin| {
        let camera = Camera {
            from: origin + DVec3::new(4.0, -8.0, 6.0),
            to: origin,
            ..level()
        };
        let drawing = Drawing {
            meshes: &meshes,
            instances: vec![body(origin + DVec3::new(0.125, 0.25, -0.375))],
            view: View::From(camera),
            ..Drawing::default()
        };
        render(&drawing, size)
    });
    assert_ne!(extent(&here)[0], [u32::MAX, 0]);
    assert_eq!(here, there);
}

#[test]
fn odd_sizes_have_no_shear() {
    let meshes = [plain_cube()];
    for size in [[101, 67], [63, 64], [65, 33], [257, 90]] {
        let drawing = Drawing {
            meshes: &meshes,
            instances: vec![body(DVec3::ZERO)],
            view: View::From(level()),
            ..Drawing::default()
        };
        let picture = render(&drawing, size);
        assert_eq!([picture.width, picture.height], size);
        assert_eq!(picture.rgba.len() as u32, 4 * size[0] * size[1]);
        let [columns, rows] = extent(&picture);
        for y in rows[0] + 1..rows[1] {
            let used = (0..size[0]).filter(|&x| picture.pixel(x, y) != WHITE);
            let used: Vec<u32> = used.collect();
            assert_eq!(
                [used[0], used[used.len() - 1]],
                columns,
                "{size:?}, row {y}"
            );
        }
        assert!((columns[0] + columns[1]).abs_diff(size[0] - 1) <= 1);
    }
}

#[test]
fn a_line_has_its_width_and_colour_and_is_cut_at_the_eye() {
    let size = [200, 150];
    let line = |ends: [DVec3; 2]| Line {
        ends,
        colour: [200, 30, 60],
        width: 5.0,
    };
    let camera = Camera {
        from: DVec3::new(0.0, -10.0, 0.5),
        ..level()
    };
    let with = |ends| {
        let drawing = Drawing {
            lines: vec![line(ends)],
            view: View::From(camera),
            ..Drawing::default()
        };
        render(&drawing, size)
    };
    let across = with([DVec3::new(-3.0, 0.0, 0.02), DVec3::new(3.0, 0.0, 0.02)]);
    let rows = (0..150)
        .filter(|&y| across.pixel(100, y) == [200, 30, 60])
        .count();
    assert!((4..=5).contains(&rows), "{rows} rows");
    // From far in front to behind the eye, below it: a line down the middle, nothing elsewhere.
    let along = with([DVec3::new(0.0, 50.0, -1.0), DVec3::new(0.0, -60.0, -1.0)]);
    let [columns, rows] = extent(&along);
    assert!(columns[0] >= 96 && columns[1] <= 103, "{columns:?}");
    assert_eq!(rows[1], 149);
}
