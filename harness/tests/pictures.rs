//! Pictures: what they show is where and what the data are, and what cannot be shown is said.

use glam::{DMat3, DVec3};
use riprap::block::{Form, Polyhedron};
use riprap::output::{Array, Image, Table};
use riprap_harness::picture::{
    Chart, Curve, Mark, Measure, Palette, Placed, Plane, Quantity, Section, Slice, Track,
};
use std::f64::consts::{FRAC_PI_4, PI};
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

type Rgb = [u8; 3];

/// Where a test may write `name`.
fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

/// Width, height and pixels of a PNG file.
fn read(path: &Path) -> (usize, usize, Vec<Rgb>) {
    let file = BufReader::new(File::open(path).expect("the picture"));
    let mut reader = png::Decoder::new(file).read_info().expect("a PNG file");
    let mut bytes = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut bytes).expect("whole pixels");
    let pixels = bytes
        .chunks(3)
        .map(|rgb| [rgb[0], rgb[1], rgb[2]])
        .collect();
    (info.width as usize, info.height as usize, pixels)
}

fn slice<'a>(quantity: Quantity<'a>, normal: usize, position: f64) -> Slice<'a> {
    Slice {
        title: "test",
        time: 0.0,
        plane: Plane { normal, position },
        quantity,
        label: "pressure",
        unit: "Pa",
        range: None,
        streamlines: false,
        blocks: &[],
    }
}

/// 4 × 2 × 3 cells of 0.5 m whose pressure counts the cells; the last cell of each row is solid.
fn counting() -> Image {
    let cells = [4, 2, 3];
    let count = cells.iter().product::<usize>();
    Image {
        origin: [0.0; 3],
        spacing: 0.5,
        cells,
        arrays: vec![
            Array {
                name: "pressure".into(),
                components: 1,
                values: (0..count).map(|cell| cell as f32).collect(),
            },
            Array {
                name: "solid".into(),
                components: 1,
                values: (0..count).map(|cell| f32::from(cell % 4 == 3)).collect(),
            },
        ],
    }
}

#[test]
fn a_section_takes_the_layer_it_cuts_in_the_order_of_the_axes() {
    let image = counting();
    let cut = |normal, position| {
        Section::new(
            &image,
            Plane { normal, position },
            Quantity::Scalar("pressure"),
        )
        .expect("a plane in the domain")
    };
    let z = cut(2, 0.75);
    assert_eq!((z.axes, z.cells), (["x", "y"], [4, 2]));
    assert_eq!(z.values, [8., 9., 10., 11., 12., 13., 14., 15.]);
    assert_eq!(
        z.solid,
        [false, false, false, true, false, false, false, true]
    );
    let y = cut(1, 1.0);
    assert_eq!((y.axes, y.cells), (["x", "z"], [4, 3]));
    assert_eq!(
        y.values,
        [4., 5., 6., 7., 12., 13., 14., 15., 20., 21., 22., 23.]
    );
    let x = cut(0, 0.0);
    assert_eq!((x.axes, x.cells), (["y", "z"], [2, 3]));
    assert_eq!(x.values, [0., 4., 8., 12., 16., 20.]);
}

#[test]
fn cells_are_drawn_as_equal_rectangles_of_their_own_colour_with_y_upwards() {
    let path = file("cells.png");
    slice(Quantity::Scalar("pressure"), 2, 0.1)
        .draw(&counting(), &path)
        .expect("a picture");
    let (width, _, pixels) = read(&path);
    // The layer holds 0 1 2 solid below 4 5 6 solid, whose colours go from 0 to 6.
    let colour = |value: f64| {
        let colour = Palette::Sequential.colour(value / 6.0);
        [colour.0, colour.1, colour.2]
    };
    let place = |rgb: Rgb| -> Vec<[usize; 2]> {
        let found = pixels
            .iter()
            .enumerate()
            .filter(|(_, pixel)| **pixel == rgb);
        found
            .map(|(index, _)| [index % width, index / width])
            .collect()
    };
    let extent = |places: &[[usize; 2]]| {
        [0, 1].map(|axis| {
            let along = places.iter().map(|place| place[axis]);
            let low = along.clone().min().expect("some pixels");
            [low, along.max().expect("some pixels")]
        })
    };
    // 1 and 5 lie above each other, in colours that the colour bar shows in a line or two only.
    let [low, high] = [1.0, 5.0].map(|value| place(colour(value)));
    let column = extent(&low)[0];
    let inside = |places: Vec<[usize; 2]>| -> Vec<[usize; 2]> {
        let right = column[0] + 10;
        places
            .into_iter()
            .filter(|place| place[0] < right.max(column[1].min(700)))
            .collect()
    };
    let (low, high) = (extent(&inside(low)), extent(&inside(high)));
    assert_eq!(low[0], high[0], "both in one column");
    assert!(high[1][1] < low[1][0], "the upper row is above");
    let heights = [low, high].map(|[_, [top, bottom]]| bottom - top);
    let size = low[0][1] - low[0][0];
    for height in heights {
        // The border's line covers a pixel of the outer edge, an edge between cells another.
        assert!(
            height.abs_diff(size) <= 2,
            "cells are square: {height} against {size}"
        );
    }
    // Text in ink on white passes through any grey, so only the map's own rows are looked at.
    let rows = high[1][0]..=low[1][1];
    let beside = low[0][1]..=low[0][1] + 2 * size + 4;
    let mut grey = place([120, 120, 120]);
    grey.retain(|place| beside.contains(&place[0]) && rows.contains(&place[1]));
    let [[left, right], [top, bottom]] = extent(&grey);
    let solid = [right - left, bottom - top];
    assert!(
        solid[0].abs_diff(size) <= 2 && solid[1].abs_diff(2 * size) <= 4,
        "two solid cells in grey, {solid:?} for a cell of {size}"
    );
    assert!(grey.len() >= solid[0] * solid[1], "without holes");
}

#[test]
fn pictures_have_the_width_of_a_page_unless_the_domain_is_high() {
    let path = file("wide.png");
    slice(Quantity::Scalar("pressure"), 2, 0.1)
        .draw(&counting(), &path)
        .expect("a picture");
    assert_eq!(read(&path).0, 1400);
    let flat = Image {
        cells: [24, 1, 1],
        ..counting()
    };
    slice(Quantity::Scalar("pressure"), 2, 0.1)
        .draw(&flat, &path)
        .expect("a picture");
    assert_eq!(read(&path).0, 1400);
    let high = Image {
        cells: [1, 24, 1],
        ..counting()
    };
    slice(Quantity::Scalar("pressure"), 2, 0.1)
        .draw(&high, &path)
        .expect("a picture");
    let (width, height, _) = read(&path);
    assert!(width < 1400 && height < 1200, "{width} × {height}");
}

#[test]
fn zero_is_in_the_middle_of_the_colours_only_where_both_signs_matter() {
    let white = [221, 221, 221];
    for (values, grey) in [
        ([-2.0, 2.0], true),
        ([-0.01, 2.0], false),
        ([1.0, 2.0], false),
    ] {
        let (palette, range) = Palette::fitting(values);
        assert_eq!(palette == Palette::Diverging, grey, "{values:?}");
        assert!(range[0] <= values[0] && range[1] >= values[1]);
    }
    let middle = Palette::Diverging.colour(0.5);
    // Moreland's middle grey, to the rounding of his table.
    for (found, wants) in [middle.0, middle.1, middle.2].into_iter().zip(white) {
        assert!(found.abs_diff(wants) <= 1, "{middle:?}");
    }
    let ends = [0.0, 1.0].map(|end| Palette::Diverging.colour(end));
    for (end, wants) in ends.iter().zip([[59, 76, 192], [180, 4, 38]]) {
        for (found, wants) in [end.0, end.1, end.2].into_iter().zip(wants) {
            assert!(found.abs_diff(wants) <= 3, "{end:?}");
        }
    }
}

#[test]
fn still_water_has_no_streamlines_and_one_value_has_colours() {
    let mut image = counting();
    let count = image.cell_count();
    image.arrays[0].values = vec![7.0; count];
    image.arrays.push(Array {
        name: "velocity".into(),
        components: 3,
        values: vec![0.0; 3 * count],
    });
    let mut still = slice(Quantity::Scalar("pressure"), 2, 0.1);
    still.streamlines = true;
    still.draw(&image, &file("still.png")).expect("a picture");
    image.arrays[0].values[0] = f32::NAN;
    let path = file("nan.png");
    still.draw(&image, &path).expect("a picture");
    assert!(
        read(&path).2.contains(&[255, 0, 255]),
        "what is no number is seen"
    );
}

#[test]
fn what_cannot_be_cut_is_refused_with_what_there_is() {
    let refusal = |quantity, normal, position| {
        let error = slice(quantity, normal, position).draw(&counting(), &file("refused.png"));
        error.expect_err("nothing to draw").to_string()
    };
    let error = refusal(Quantity::Scalar("speed"), 2, 0.1);
    assert!(
        error.contains("no array `speed`; it has pressure, solid"),
        "{error}"
    );
    let error = refusal(Quantity::Component("pressure", 2), 2, 0.1);
    assert!(error.contains("component 2 is none of them"), "{error}");
    let error = refusal(Quantity::Scalar("pressure"), 2, 1.6);
    assert!(
        error.contains("z = 1.6 m misses the domain") && error.contains("0 to 1.5 m"),
        "{error}"
    );
    let error = refusal(Quantity::Scalar("pressure"), 3, 0.0);
    assert!(error.contains("give 0 (x), 1 (y) or 2 (z)"), "{error}");
}

#[test]
fn a_history_names_missing_columns_and_survives_gaps() {
    let table = Table {
        columns: vec![
            ("time".into(), vec![0.0, 1.0, 2.0, 3.0]),
            ("pressure".into(), vec![1.0, f64::NAN, 2.0, 3.0]),
        ],
    };
    let track = |columns| {
        [Track {
            quantity: "pressure",
            unit: "Pa",
            columns,
        }]
    };
    let error = Chart::history("gauge", &table, &track(&["force"])).expect_err("no such column");
    assert!(
        error
            .to_string()
            .contains("no column `force`; it has time, pressure"),
        "{error}"
    );
    let path = file("history.png");
    let history = Chart::history("gauge", &table, &track(&["pressure"])).expect("a history");
    history.draw(&path).expect("a picture");
    assert_eq!(read(&path).0, 1400);
}

#[test]
fn a_curve_is_drawn_where_its_values_are() {
    let curve = |points: Vec<[f64; 2]>| Curve {
        name: "a".into(),
        points,
        mark: Mark::Points,
    };
    let path = file("profile.png");
    let rising = vec![[1.0, 1.0], [10.0, 10.0], [100.0, 100.0]];
    let (x, y) = (Measure::logarithmic("x", ""), Measure::logarithmic("y", ""));
    let curves = vec![curve(vec![]), curve(rising)];
    Chart::profile("rising", x, y, curves)
        .draw(&path)
        .expect("a picture");
    let (width, height, pixels) = read(&path);
    // The second curve's colour, below the legend.
    let second = [213, 94, 0];
    let found = |index: &usize| pixels[*index] == second && index / width > height / 8;
    let places: Vec<[usize; 2]> = (0..pixels.len())
        .filter(found)
        .map(|index| [index % width, index / width])
        .collect();
    let middle = |axis: usize| {
        let along = || places.iter().map(|place| place[axis]);
        along().min().expect("a point") + along().max().expect("a point")
    };
    // Three discs of 5 pixels' radius, the middle one half-way between the others on log scales.
    let about = places.iter().filter(|place| {
        (2 * place[0]).abs_diff(middle(0)) <= 12 && (2 * place[1]).abs_diff(middle(1)) <= 12
    });
    assert!(about.count() > 40, "a disc in the middle");
}

#[test]
fn a_picture_that_cannot_be_written_says_why() {
    let path = file("missing/folder.png");
    let error = slice(Quantity::Scalar("pressure"), 2, 0.1).draw(&counting(), &path);
    let error = error.expect_err("no folder").to_string();
    assert!(error.contains("create its folder first"), "{error}");
}

/// A cube of 1 m whose place is (1, 1, 0.75), turned about z by 45°, and a ball of 0.5 m at its side.
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
    let image = Image {
        origin: [0.0, 0.0, 0.7],
        spacing: 0.1,
        cells,
        arrays: vec![Array {
            name: "pressure".into(),
            components: 1,
            values,
        }],
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
    // A square of 1 m², and of the ball a disc of radius √(0.25 − 0.0625) m, whose outlines are one pixel within.
    let radius = (0.25_f64 - 0.0625).sqrt();
    let covered = (1.0 + PI * radius * radius) * scale * scale;
    let outlines = (4.0 + 2.0 * PI * radius) * scale;
    let grey = count([120, 120, 120]) + outlines;
    assert!((grey / covered - 1.0).abs() < 0.02, "{grey} of {covered}");
}
