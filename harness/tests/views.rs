//! Views of runs: what they write, and what is in it.

mod rig;

use rig::{args, folder, go};
use riprap_harness::render::Picture;
use std::fs;

/// Water that an inlet drives over a step, seen in space.
const STEP: &str = r#"
    title = "step"
    [domain]
    size = [0.32, 0.16, 0.16]
    cell = 0.01
    [fluid]
    viscosity = 1e-3
    [numerics]
    velocity_scale = 1
    [boundaries]
    x_min = { kind = "velocity", velocity = [0.5, 0, 0] }
    x_max = { kind = "pressure" }
    z_min = { kind = "wall" }
    z_max = { kind = "free_slip" }
    [initial]
    velocity = [0.5, 0, 0]
    [[solids]]
    kind = "box"
    name = "step"
    min = [0.1, 0, 0]
    max = [0.16, 0.08, 0.06]
    [run]
    steps = 40
"#;

/// Pixels that are neither grey nor sandstone: colours of the fluid.
fn coloured(picture: &Picture) -> usize {
    let pixels = picture
        .rgba
        .chunks(4)
        .map(|p| [0, 1, 2].map(|channel| i32::from(p[channel])));
    // Viridis runs from violet over green to yellow; sandstone and grey have red ≥ green ≥ blue.
    pixels
        .filter(|[r, g, b]| *g > r + 20 || *b > g + 20)
        .count()
}

const VIEWS: &str = r#"
    [[views]]
    name = "both"
    size = [640, 400]
    every = 0.02
    traces = 30
    slices = [{ axis = "y", field = "speed" }]
    [[views]]
    name = "bare"
    size = [640, 400]
    animation = false
    strip = 0
    slices = [{ axis = "y", field = "pressure", range = [-200, 200] }]
"#;

#[test]
fn a_view_of_a_flow_shows_slices_traces_and_solids_and_makes_strip_and_animation() {
    let folder = folder("views_step");
    let text = format!("{STEP}{VIEWS}");
    let summary = go(&args(&folder, &text, "whole"));
    assert!(summary.complete && summary.warnings.is_empty(), "{summary}");
    let out = folder.join("whole");
    let named = |name: &str| out.join(format!("{name}.png"));
    for name in [
        "both_000000",
        "both_000040",
        "both_strip",
        "both",
        "bare_000040",
    ] {
        let listed = summary.files.contains(&named(name));
        assert!(listed, "{name} of {:?}", summary.files);
    }
    assert!(!named("bare_strip").is_file() && !named("bare").is_file());
    for name in ["both_000040", "bare_000040"] {
        let picture = Picture::load(&named(name)).unwrap();
        assert_eq!([picture.width, picture.height], [640, 400]);
        let found = coloured(&picture);
        assert!(found > 20_000, "{name}: {found} pixels");
        // The step, and nothing else so large, has the grey of what is fixed.
        let grey = picture
            .rgba
            .chunks(4)
            .filter(|p| p[0] == p[1] && p[1] == p[2] && (50..190).contains(&p[0]));
        assert!(grey.count() > 5000, "{name}");
    }

    // A run that is interrupted has the same pictures: nothing in them depends on where it began.
    let mut parts = args(&folder, &text, "parts");
    parts.steps = Some(20);
    parts.restart = go(&parts).checkpoint;
    parts.steps = None;
    go(&parts);
    for name in ["both_000040.png", "bare_000040.png"] {
        let [one, two] = ["whole", "parts"].map(|run| fs::read(folder.join(run).join(name)));
        assert!(one.unwrap() == two.unwrap(), "{name} differs");
    }
    fs::remove_dir_all(folder).unwrap();
}
