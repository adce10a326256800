//! Annotations around a view, and the framing by the camera.

use super::fixture::{body, drawing, extent, level, plain_cube, render};
use glam::{DMat3, DVec3};
use riprap::geometry::Polyhedron;
use riprap_harness::render::{Background, Drawing, Ground, Instance, Look, Mesh, Picture, View};

#[test]
fn the_scale_bar_is_as_long_as_an_edge_of_that_length() {
    let size = [400, 300];
    // 0.2 of the view is 0.70 m at this distance, so the bar is 0.5 m long.
    let half = 0.5 * Polyhedron::cuboid(DVec3::ONE).expect("a cube").radius() / 0.75_f64.sqrt();
    let meshes = [plain_cube()];
    // A thin plate of 0.5 m × 0.5 m in the plane of the target.
    let plate = Instance {
        deformation: DMat3::from_diagonal(DVec3::new(half, 1e-3, half)),
        ..body(DVec3::ZERO)
    };
    let [[first, last], _] = extent(&render(&drawing(&meshes, vec![plate], level()), size));
    let plate = f64::from(last - first + 1);
    let only_bar = Drawing {
        scale_bar: true,
        ..drawing(&[], Vec::new(), level())
    };
    let picture = render(&only_bar, size);
    // The longest dark run of a row.
    let run = |y: u32| {
        (0..size[0])
            .filter(|&x| picture.pixel(x, y)[0] < 128)
            .count()
    };
    let bar = (0..size[1]).map(run).max().expect("rows") as f64;
    let exact = 0.5 * 150.0 / (10.0 * 7.5_f64.to_radians().tan());
    assert!((plate - exact).abs() <= 2.0, "plate {plate}, {exact}");
    // The ends are 2 pixels wide, half of which is beyond the length.
    assert!((bar - 2.0 - exact).abs() <= 2.0, "bar {bar}, {exact}");
}

#[test]
fn title_time_and_label_are_drawn_and_leave_the_view_alone() {
    let size = [400, 200];
    let meshes = [plain_cube()];
    let with = |title: &str, time| {
        let drawing = Drawing {
            title: title.into(),
            time,
            ..drawing(&meshes, vec![body(DVec3::ZERO)], level())
        };
        render(&drawing, size)
    };
    // Dark pixels of the head, left and right.
    let ink = |picture: &Picture, columns: std::ops::Range<u32>| {
        let rows = 0..50;
        let dark = |x: u32| {
            rows.clone()
                .filter(|&y| picture.pixel(x, y)[0] < 100)
                .count()
        };
        columns.map(dark).sum::<usize>()
    };
    let both = with("Cube", Some(0.5));
    assert!(ink(&both, 0..200) > 50 && ink(&both, 200..400) > 50);
    let untimed = with("Cube", None);
    assert_eq!(ink(&untimed, 200..400), 0);
    assert_eq!(ink(&untimed, 0..200), ink(&both, 0..200));
    let other = with("Sphere", Some(0.5));
    assert_ne!(ink(&other, 0..200), ink(&both, 0..200));
    let below = |picture: &Picture| picture.rgba[4 * 400 * 70..].to_vec();
    assert_eq!(below(&both), below(&other));
}

#[test]
fn a_framing_camera_fits_all_blocks_into_the_view() {
    let size = [300, 200];
    let meshes = [plain_cube(), Mesh::sphere(0.7, 2)];
    let mut instances: Vec<Instance> = [[0.0, 0.0, 0.0], [9.0, 2.0, 1.0], [-4.0, 7.0, 3.0]]
        .map(|centre| body(DVec3::from_array(centre)))
        .to_vec();
    instances[1].mesh = 1;
    for direction in [
        DVec3::Y,
        DVec3::new(-1.0, 1.0, -1.0),
        DVec3::new(1.0, 0.2, -3.0),
    ] {
        let drawing = Drawing {
            meshes: &meshes,
            instances: instances.clone(),
            view: View::Framing(Look {
                direction,
                ..Look::default()
            }),
            ..Drawing::default()
        };
        let [columns, rows] = extent(&render(&drawing, size));
        let free = |[first, last]: [u32; 2], size: u32| {
            [first, size - 1 - last].map(|pixels| f64::from(pixels) / f64::from(size))
        };
        let (x, y) = (free(columns, size[0]), free(rows, size[1]));
        // The margin is 0.06 of half of the view; in one of the directions nothing more is left.
        let least = x.into_iter().chain(y).fold(1.0, f64::min);
        assert!(least > 0.02, "{direction}: {x:?} {y:?}");
        let tight = x.iter().all(|free| *free < 0.05) || y.iter().all(|free| *free < 0.05);
        assert!(tight, "{direction}: {x:?} {y:?}");
    }
}

#[test]
fn an_empty_scene_is_a_white_picture_or_a_ground() {
    let size = [90, 60];
    let empty = render(&Drawing::default(), size);
    assert!(empty.rgba.iter().all(|&channel| channel == 255));
    let ground = render(
        &Drawing {
            ground: Some(Ground { height: 0.0 }),
            background: Background::Sky,
            ..Drawing::default()
        },
        size,
    );
    assert_ne!(extent(&ground)[0], [u32::MAX, 0]);
}
