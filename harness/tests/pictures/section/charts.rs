//! Charts of curves.

use super::fixture::{file, read};
use riprap::output::Table;
use riprap_harness::picture::{Chart, Curve, Mark, Measure, Track};

#[test]
fn a_history_names_missing_columns_and_survives_gaps() {
    let table = Table {
        columns: vec![
            ("time".into(), vec![0.0, 1.0, 2.0, 3.0]),
            ("pressure".into(), vec![1.0, f64::NAN, 2.0, 3.0]),
        ],
    };
    let history =
        |column| Chart::history("gauge", &table, &[Track::new("pressure", "Pa", &[column])]);
    let error = history("force").expect_err("no such column").to_string();
    assert!(
        error.contains("no column `force`; it has time, pressure"),
        "{error}"
    );
    let path = file("history.png");
    let chart = history("pressure").expect("a history");
    chart.draw(&path).expect("a picture");
    assert_eq!(read(&path).0, 1400);
}

fn rising() -> Chart {
    let curve = |name: &str, points: Vec<[f64; 2]>| Curve {
        name: name.into(),
        points,
        mark: Mark::Points,
    };
    let points = vec![[1.0, 1.0], [10.0, 10.0], [100.0, 100.0], [f64::NAN, 0.0]];
    let (x, y) = (Measure::logarithmic("x", ""), Measure::logarithmic("y", ""));
    let curves = vec![curve("a < b & c", vec![]), curve("rising", points)];
    Chart::profile("rising", x, y, curves)
}

#[test]
fn a_curve_is_drawn_where_its_values_are() {
    let path = file("profile.png");
    rising().draw(&path).expect("a picture");
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
    // Three discs of 5 pixels' radius, the middle one midway between the others on log scales.
    let about = places.iter().filter(|place| {
        (2 * place[0]).abs_diff(middle(0)) <= 12 && (2 * place[1]).abs_diff(middle(1)) <= 12
    });
    assert!(about.count() > 40, "a disc in the middle");
}

#[test]
fn an_svg_is_whole_and_has_the_curves_and_their_names() {
    let svg = rising().svg().expect("a drawing");
    assert!(
        svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"),
        "{svg}"
    );
    assert!(svg.contains("a &lt; b &amp; c"), "{svg}");
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    // Three points, and three in the legend for each curve.
    assert_eq!(svg.matches("<circle").count(), 9);
}
