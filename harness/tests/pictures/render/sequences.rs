//! Animations and strips.

use super::fixture::{WHITE, body, drawing, level, plain_cube, renderer, speed};
use glam::DVec3;
use riprap_harness::render::{Drawing, Instance, View, animate};
use std::fs::File;
use std::io::BufReader;
use std::path::Path;
use std::time::Duration;

#[test]
fn an_animation_has_its_frames_in_order_and_plays_for_ever() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cubes.png");
    let meshes = [plain_cube()];
    let renderer = renderer([75, 51]);
    let frame = |index: usize| {
        let drawing = drawing(
            &meshes,
            vec![body(DVec3::new(0.3 * index as f64 - 0.3, 0.0, 0.0))],
            level(),
        );
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
