//! Pictures in space: bodies are where the camera sees them, nearer ones hide farther ones, colours and lengths
//! can be read, and what cannot be drawn is said.

use glam::{DMat3, DQuat, DVec3};
use riprap::block::Polyhedron;
use riprap::wgpu::{self, naga};
use riprap_harness::gpu;
use riprap_harness::picture::Palette;
use riprap_harness::render::{
    Background, Camera, Colours, Drawing, Ground, Instance, Line, Look, Mesh, Picture, Renderer,
    SHADERS, Surface, Vertex, View, animate,
};
use std::fs::File;
use std::io::BufReader;
use std::path::Path;
use std::sync::LazyLock;
use std::time::Duration;

const WHITE: [u8; 3] = [255; 3];

static DEVICE: LazyLock<(wgpu::Device, wgpu::Queue)> = LazyLock::new(|| {
    let adapter = gpu::pick(None).expect("an adapter");
    // No more than every device of WebGPU has.
    gpu::open(&adapter, wgpu::Features::empty(), wgpu::Limits::default()).expect("a device")
});

fn renderer(size: [u32; 2]) -> Renderer {
    Renderer::new(&DEVICE.0, &DEVICE.1, size).expect("a renderer")
}

fn render(drawing: &Drawing<'_>, size: [u32; 2]) -> Picture {
    renderer(size).render(drawing).expect("a picture")
}

/// What rendering is refused with.
fn refusal(drawing: &Drawing<'_>) -> String {
    let refused = renderer([64, 48]).render(drawing);
    refused.expect_err("an error").to_string()
}

/// A cube with edges of 1 m, without lines on its edges.
fn plain_cube() -> Mesh {
    let cube = Polyhedron::cuboid(DVec3::ONE).expect("a cube");
    Mesh {
        edges: Vec::new(),
        ..Mesh::of(&cube)
    }
}

fn body(centre: DVec3) -> Instance {
    Instance {
        mesh: 0,
        centre,
        deformation: DMat3::IDENTITY,
        value: None,
        fixed: false,
    }
}

/// Along +y from 10 m before the origin.
fn level() -> Camera {
    Camera {
        from: DVec3::new(0.0, -10.0, 0.0),
        to: DVec3::ZERO,
        up: DVec3::Z,
        field_of_view: 15_f64.to_radians(),
    }
}

/// From the right and above, 10 m from the origin: three faces of a cube there are seen.
fn oblique() -> Camera {
    Camera {
        from: 10.0 * DVec3::new(0.4, -0.8, 0.6).normalize(),
        ..level()
    }
}

fn speed(range: [f64; 2]) -> Option<Colours> {
    Some(Colours {
        label: "speed".into(),
        unit: "m/s".into(),
        range: Some(range),
    })
}

/// Where a pinhole camera sees a point, pixels from the upper left.
fn seen(camera: &Camera, [width, height]: [u32; 2], point: DVec3) -> [f64; 2] {
    let forward = (camera.to - camera.from).normalize();
    let right = forward.cross(camera.up).normalize();
    let up = right.cross(forward);
    let offset = point - camera.from;
    let scale = 0.5 * f64::from(height) / (0.5 * camera.field_of_view).tan() / offset.dot(forward);
    [
        0.5 * f64::from(width) + scale * offset.dot(right),
        0.5 * f64::from(height) - scale * offset.dot(up),
    ]
}

fn pixel_at(picture: &Picture, [x, y]: [f64; 2]) -> [u8; 3] {
    picture.pixel(x as u32, y as u32)
}

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

fn linear(srgb: u8) -> f64 {
    let c = f64::from(srgb) / 255.0;
    if c <= 0.04045 {
        c / 12.92
    } else {
        ((c + 0.055) / 1.055).powf(2.4)
    }
}

/// Columns and rows that are not white: first and last of each.
fn extent(picture: &Picture) -> [[u32; 2]; 2] {
    let mut found = [[u32::MAX, 0]; 2];
    for y in 0..picture.height {
        for x in 0..picture.width {
            if picture.pixel(x, y) != WHITE {
                for (range, at) in found.iter_mut().zip([x, y]) {
                    *range = [range[0].min(at), range[1].max(at)];
                }
            }
        }
    }
    found
}

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

/// Middle of the leftmost run of coloured pixels in the middle row.
fn body_in_the_middle_row(picture: &Picture) -> [u32; 2] {
    let y = picture.height / 2;
    let first = (0..picture.width).find(|&x| picture.pixel(x, y) != WHITE);
    let first = first.expect("a body");
    let last = (first..picture.width).find(|&x| picture.pixel(x, y) == WHITE);
    [(first + last.expect("an end")) / 2, y]
}

#[test]
fn shaded_colours_keep_the_ratios_of_the_colour_map() {
    let meshes = [plain_cube()];
    let size = [420, 200];
    for value in [0.0, 0.35, 0.7, 1.0] {
        let drawing = Drawing {
            meshes: &meshes,
            instances: vec![Instance {
                value: Some(value),
                ..body(DVec3::ZERO)
            }],
            view: View::From(level()),
            colours: speed([0.0, 1.0]),
            ..Drawing::default()
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
fn fixed_blocks_are_grey_and_surfaces_without_light_have_their_own_colour() {
    let size = [120, 90];
    let meshes = [plain_cube()];
    let mut drawing = Drawing {
        meshes: &meshes,
        instances: vec![Instance {
            value: Some(1.0),
            fixed: true,
            ..body(DVec3::ZERO)
        }],
        view: View::From(level()),
        ..Drawing::default()
    };
    let [r, g, b] = render(&drawing, size).pixel(60, 45);
    assert!(r == g && g == b && r < 255, "{r} {g} {b}");
    // A triangle before it.
    let colour = [17, 130, 201];
    let corners = [[-1.0, -1.0], [1.0, -1.0], [0.0, 1.5]];
    drawing.surfaces = vec![Surface {
        vertices: corners
            .map(|[x, z]| Vertex {
                position: DVec3::new(x, -1.0, z),
                normal: -DVec3::Y,
            })
            .to_vec(),
        colours: vec![colour; 3],
        triangles: vec![[0, 1, 2]],
        lit: false,
    }];
    assert_eq!(render(&drawing, size).pixel(60, 45), colour);
}

#[test]
fn the_three_visible_faces_of_a_cube_differ() {
    let size = [240, 180];
    let meshes = [plain_cube()];
    let drawing = Drawing {
        meshes: &meshes,
        instances: vec![body(DVec3::ZERO)],
        view: View::From(oblique()),
        ..Drawing::default()
    };
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
    let drawing = Drawing {
        meshes: &meshes,
        instances: vec![body(DVec3::ZERO)],
        view: View::From(oblique()),
        ..Drawing::default()
    };
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
        meshes: &meshes,
        instances: vec![body(DVec3::new(0.0, 0.0, 1.0))],
        view: View::From(camera),
        ground: Some(Ground { height: 0.0 }),
        sun: Some(DVec3::new(1.0, 0.0, 1.0)),
        ..Drawing::default()
    };
    let picture = render(&drawing, size);
    // Between the lines of the grid.
    let spot = |x: f64| pixel_at(&picture, seen(&camera, size, DVec3::new(x, 0.07, 0.0)))[0];
    assert!(spot(1.07) > 200, "open ground {}", spot(1.07));
    assert!(spot(-1.07) < 190, "shadow {}", spot(-1.07));
}

#[test]
fn the_scale_bar_is_as_long_as_an_edge_of_that_length() {
    let size = [400, 300];
    // 0.2 of the view is 0.70 m at this distance, so the bar is 0.5 m long.
    let half = 0.5 * Polyhedron::cuboid(DVec3::ONE).expect("a cube").radius() / 0.75_f64.sqrt();
    let meshes = [plain_cube()];
    let drawing = Drawing {
        meshes: &meshes,
        // A thin plate of 0.5 m × 0.5 m in the plane of the target.
        instances: vec![Instance {
            deformation: DMat3::from_diagonal(DVec3::new(half, 1e-3, half)),
            ..body(DVec3::ZERO)
        }],
        view: View::From(level()),
        ..Drawing::default()
    };
    let [[first, last], _] = extent(&render(&drawing, size));
    let plate = f64::from(last - first + 1);
    let only_bar = Drawing {
        view: View::From(level()),
        scale_bar: true,
        ..Drawing::default()
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
            meshes: &meshes,
            instances: vec![body(DVec3::ZERO)],
            view: View::From(level()),
            title: title.into(),
            time,
            ..Drawing::default()
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
        // The margin is 0.06 of half of the view; one of the directions uses it up.
        let least = x.into_iter().chain(y).fold(1.0, f64::min);
        assert!(least > 0.02, "{direction}: {x:?} {y:?}");
        let tight = x.iter().all(|free| *free < 0.05) || y.iter().all(|free| *free < 0.05);
        assert!(tight, "{direction}: {x:?} {y:?}");
    }
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

#[test]
fn what_cannot_be_drawn_is_said() {
    let meshes = [plain_cube()];
    let good = Drawing {
        meshes: &meshes,
        instances: vec![body(DVec3::ZERO), body(DVec3::X)],
        ..Drawing::default()
    };
    let with = |change: &dyn Fn(&mut Drawing<'_>)| {
        let mut drawing = good.clone();
        change(&mut drawing);
        refusal(&drawing)
    };
    let pose = with(&|d| d.instances[1].centre.y = f64::NAN);
    assert!(
        pose.contains("instances[1]") && pose.contains("pose"),
        "{pose}"
    );
    let turn = with(&|d| d.instances[0].deformation.y_axis.x = f64::INFINITY);
    assert!(turn.contains("instances[0]"), "{turn}");
    let value = with(&|d| d.instances[1].value = Some(f64::NAN));
    assert!(
        value.contains("instances[1]") && value.contains("value"),
        "{value}"
    );
    let mesh = with(&|d| d.instances[1].mesh = 7);
    assert!(mesh.contains("mesh 7"), "{mesh}");
    let range = with(&|d| d.colours = speed([1.0, 1.0]));
    assert!(range.contains("colours.range"), "{range}");
    let camera = with(&|d| {
        d.view = View::From(Camera {
            to: level().from,
            ..level()
        });
    });
    assert!(camera.contains("camera"), "{camera}");
    let up = with(&|d| {
        d.view = View::From(Camera {
            up: DVec3::Y,
            ..level()
        });
    });
    assert!(up.contains("parallel"), "{up}");
    let line = with(&|d| {
        d.lines = vec![Line {
            ends: [DVec3::ZERO, DVec3::NAN],
            colour: [0; 3],
            width: 1.0,
        }];
    });
    assert!(line.contains("lines[0]"), "{line}");
    let (device, queue) = &*DEVICE;
    for size in [[0, 10], [10, 1 << 20]] {
        let refused = Renderer::new(device, queue, size).err();
        assert!(refused.is_some_and(|error| error.to_string().contains("pixels")));
    }
}

#[test]
fn an_animation_has_its_frames_in_order_and_plays_for_ever() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cubes.png");
    let meshes = [plain_cube()];
    let renderer = renderer([75, 51]);
    let frame = |index: usize| {
        let drawing = Drawing {
            meshes: &meshes,
            instances: vec![body(DVec3::new(0.3 * index as f64 - 0.3, 0.0, 0.0))],
            view: View::From(level()),
            ..Drawing::default()
        };
        renderer.render(&drawing)
    };
    animate(&path, 3, Duration::from_millis(40), (0..3).map(frame)).expect("an animation");
    let file = BufReader::new(File::open(&path).expect("the file"));
    let mut reader = png::Decoder::new(file).read_info().expect("a PNG file");
    let control = reader.info().animation_control.expect("an animation");
    assert_eq!((control.num_frames, control.num_plays), (3, 0));
    let mut bytes = vec![0; reader.output_buffer_size().expect("a size")];
    for index in 0..3 {
        reader.next_frame(&mut bytes).expect("a frame");
        let delay = reader.info().frame_control.expect("a frame's control");
        assert_eq!((delay.delay_num, delay.delay_den), (40, 1000));
        let drawn = frame(index).expect("a picture");
        let rgb = drawn.rgba.chunks(4).flat_map(|p| [p[0], p[1], p[2]]);
        assert!(rgb.eq(bytes.iter().copied()), "frame {index}");
    }
    let short = animate(&path, 4, Duration::from_millis(40), (0..3).map(frame));
    assert!(short.expect_err("too few").to_string().contains("3 frames"));
}

#[test]
fn a_strip_has_all_frames_and_one_meaning_of_colours() {
    let meshes = [plain_cube()];
    let frame = |index: usize, range| Drawing {
        meshes: &meshes,
        instances: vec![Instance {
            value: Some(index as f64),
            ..body(DVec3::ZERO)
        }],
        view: View::From(level()),
        time: Some(index as f64),
        colours: speed(range),
        ..Drawing::default()
    };
    let size = [120, 160];
    let frames: Vec<_> = (0..5).map(|index| frame(index, [0.0, 4.0])).collect();
    let strip = renderer(size).strip(&frames, 3).expect("a strip");
    assert!(strip.width > 3 * 120 && strip.height > 2 * 160);
    // Bodies along the middles of both rows of frames: runs of colour.
    let runs = |y: u32, columns: u32| {
        let body = |x: u32| strip.pixel(x, y) != WHITE;
        (1..columns).filter(|&x| body(x) && !body(x - 1)).count()
    };
    assert_eq!(runs(strip.height / 4 + 16, 390), 3);
    assert_eq!(runs(strip.height - 80, 390), 2);
    let mixed = [frame(0, [0.0, 1.0]), frame(1, [0.0, 2.0])];
    let refused = renderer(size).strip(&mixed, 2);
    assert!(
        refused
            .expect_err("two ranges")
            .to_string()
            .contains("colours.range")
    );
}
