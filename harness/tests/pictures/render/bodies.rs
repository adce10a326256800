//! Bodies and lines are drawn where the camera sees them, and nearer ones hide farther ones.

use super::fixture::{
    WHITE, body, body_in_the_middle_row, drawing, extent, level, plain_cube, render, speed,
};
use glam::{DMat3, DVec3};
use riprap::geometry::Polyhedron;
use riprap_harness::render::{Camera, Drawing, Instance, Line, Mesh, View};

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
            colours: speed([0.0, 1.0]),
            ..drawing(&meshes, instances, level())
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
            // Stretched as well as rotated: normals must follow the surface.
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
    // Rounding may change single samples of an outline.
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
    // Positions in eighths of a metre are exact in f64 at both origins, and not in f32 at the far one.
    let [here, there] = [DVec3::ZERO, DVec3::new(3e8, -5e8, 1e8)].map(|origin| {
        let camera = Camera {
            from: origin + DVec3::new(4.0, -8.0, 6.0),
            to: origin,
            ..level()
        };
        let drawing = drawing(
            &meshes,
            vec![body(origin + DVec3::new(0.125, 0.25, -0.375))],
            camera,
        );
        render(&drawing, size)
    });
    assert_ne!(extent(&here)[0], [u32::MAX, 0]);
    assert_eq!(here, there);
}

#[test]
fn odd_sizes_have_no_shear() {
    let meshes = [plain_cube()];
    for size in [[101, 67], [63, 64], [65, 33], [257, 90]] {
        let drawing = drawing(&meshes, vec![body(DVec3::ZERO)], level());
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
    // From far in front of the eye to behind it, below it: a line down the middle, nothing elsewhere.
    let along = with([DVec3::new(0.0, 50.0, -1.0), DVec3::new(0.0, -60.0, -1.0)]);
    let [columns, rows] = extent(&along);
    assert!(columns[0] >= 96 && columns[1] <= 103, "{columns:?}");
    assert_eq!(rows[1], 149);
}
