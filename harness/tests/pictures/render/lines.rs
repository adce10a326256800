//! Lines in space.

use super::fixture::{extent, level, render};
use glam::DVec3;
use riprap_harness::render::{Camera, Drawing, Line, View};

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
