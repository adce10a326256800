//! Colour maps.

use super::fixture::{Rgb, counting, file, read, slice};
use riprap::output::{Array, ImageData};
use riprap_harness::picture::{Palette, Plane, Quantity, Section};

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
    // 0 and 2 are below 4 and 6; the colour bar shows their colours in few lines.
    let size = |value: f64| place(colour(value)).len() as f64;
    let mean = |value: f64, axis: usize| {
        let places = place(colour(value));
        places.iter().map(|place| place[axis] as f64).sum::<f64>() / places.len() as f64
    };
    let edge = size(1.0).sqrt();
    for [low, high] in [[0.0, 4.0], [1.0, 5.0], [2.0, 6.0]] {
        for value in [low, high] {
            // The border covers a pixel of the outer edges.
            assert!((size(value).sqrt() - edge).abs() < 4.0, "equal squares");
        }
        let across = mean(high, 0) - mean(low, 0);
        assert!(across.abs() < 4.0, "both in one column: {across}");
        let up = mean(low, 1) - mean(high, 1);
        assert!((up - edge).abs() < 4.0, "the upper row is above: {up}");
    }
    // Dark text on white contains every grey.
    let grey = place([120, 120, 120]).len() as f64 / (2.0 * edge * edge);
    assert!((grey - 1.0).abs() < 0.02, "two solid cells in grey: {grey}");
}

#[test]
fn pictures_have_the_width_of_a_page_unless_the_domain_is_high() {
    let path = file("wide.png");
    slice(Quantity::Scalar("pressure"), 2, 0.1)
        .draw(&counting(), &path)
        .expect("a picture");
    assert_eq!(read(&path).0, 1400);
    let flat = ImageData {
        cells: [24, 1, 1],
        ..counting()
    };
    slice(Quantity::Scalar("pressure"), 2, 0.1)
        .draw(&flat, &path)
        .expect("a picture");
    assert_eq!(read(&path).0, 1400);
    let high = ImageData {
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
    for (values, grey) in [
        ([-2.0, 2.0], true),
        ([-0.01, 2.0], false),
        ([1.0, 2.0], false),
    ] {
        let (palette, range) = Palette::fitting(values);
        assert_eq!(palette == Palette::Diverging, grey, "{values:?}");
        assert!(range[0] <= values[0] && range[1] >= values[1]);
    }
    let [low, middle, high] = [0.0, 0.5, 1.0].map(|at| Palette::Diverging.colour(at));
    assert!(
        middle.0.abs_diff(middle.2) < 10 && middle.1 > 200,
        "{middle:?} is no light grey"
    );
    assert!(
        low.2 > low.0 && high.0 > high.2,
        "{low:?} is not blue or {high:?} not red"
    );
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
    let error = refusal(Quantity::Scalar("pressure"), 2, 1.6);
    assert!(
        error.contains("z = 1.6 m misses the domain") && error.contains("0 to 1.5 m"),
        "{error}"
    );
    let error = refusal(Quantity::Scalar("pressure"), 3, 0.0);
    assert!(error.contains("give 0 (x), 1 (y) or 2 (z)"), "{error}");
}

#[test]
fn a_picture_that_cannot_be_written_says_why() {
    let path = file("missing/folder.png");
    let error = slice(Quantity::Scalar("pressure"), 2, 0.1).draw(&counting(), &path);
    let error = error.expect_err("no folder").to_string();
    assert!(error.contains("create its folder first"), "{error}");
}
