//! Views of runs: files and their content.

use crate::fixture::{args, folder, go, restarted};
use riprap_harness::render::Picture;

/// Water driven over a step by an inlet, in a view.
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
    // Viridis goes from violet over green to yellow; sandstone and grey have red ≥ green ≥ blue.
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
    // A run that is interrupted has the same pictures: nothing in them depends on its first step.
    let pictures = ["both_000040.png", "bare_000040.png"];
    let summary = restarted(&folder, &text, 20, &pictures);
    assert!(summary.warnings.is_empty(), "{summary}");
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
        // Only the step is that large and has the grey of fixed bodies.
        let grey = picture
            .rgba
            .chunks(4)
            .filter(|p| p[0] == p[1] && p[1] == p[2] && (50..190).contains(&p[0]));
        assert!(grey.count() > 5000, "{name}");
    }
}

/// Pixels with the colour of sandstone in any light.
fn sandstone(picture: &Picture) -> usize {
    let pixels = picture
        .rgba
        .chunks(4)
        .map(|p| [0, 1, 2].map(|channel| f64::from(p[channel])));
    // Its channels have the ratios 205 : 190 : 165; grey and white do not, and viridis has others.
    pixels
        .filter(|[r, g, b]| {
            *r < 215.0 && (g / r - 0.92).abs() < 0.03 && (b / r - 0.80).abs() < 0.05
        })
        .count()
}

#[test]
fn blocks_in_a_flow_have_the_colour_of_stone_before_the_slice_behind_them() {
    let folder = folder("views_blocks");
    let block = r#"
        [[materials]]
        name = "rock"
        density = 2600
        normal_stiffness = 1e7
        friction = 30
        [[blocks]]
        name = "cube"
        kind = "box"
        size = [0.04, 0.04, 0.04]
        position = [0.22, 0.08, 0.1]
        rotation = { axis = [1, 1, 0], angle = 30 }
    "#;
    let text = format!("{}{block}{VIEWS}", STEP.replace("steps = 40", "steps = 4"));
    let summary = go(&args(&folder, &text, "out"));
    assert!(summary.complete, "{summary}");
    for name in ["both_000004", "bare_000004"] {
        let picture = Picture::load(&folder.join(format!("out/{name}.png"))).unwrap();
        // The domain is 0.32 m long over some 400 pixels, of which the cube's silhouette takes some 50².
        let found = sandstone(&picture);
        assert!(found > 1000, "{name}: {found} pixels of stone");
        assert!(coloured(&picture) > 10_000, "{name}");
    }
}
