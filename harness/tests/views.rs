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

#[test]
fn a_view_of_a_flow_shows_slices_traces_and_solids_and_makes_strip_and_animation() {
    let folder = folder("views_step");
    let text = format!(
        "{STEP}\n[[views]]\nname = \"both\"\nsize = [640, 400]\nevery = 0.02\ntraces = 30\n\
         slices = [{{ axis = \"y\", field = \"speed\" }}]\n\
         [[views]]\nname = \"bare\"\nsize = [640, 400]\nanimation = false\nstrip = 0\n\
         slices = [{{ axis = \"y\", field = \"pressure\", range = [-200, 200] }}]\n"
    );
    let summary = go(&args(&folder, &text, "out"));
    assert!(summary.complete && summary.warnings.is_empty(), "{summary}");
    let out = folder.join("out");
    let named = |name: &str| out.join(format!("{name}.png"));
    for name in [
        "both_000000",
        "both_000040",
        "both_strip",
        "both",
        "bare_000040",
    ] {
        assert!(
            summary.files.contains(&named(name)),
            "{name} of {:?}",
            summary.files
        );
    }
    assert!(!named("bare_strip").is_file() && !named("bare").is_file());
    for name in ["both_000040", "bare_000040"] {
        let picture = Picture::load(&named(name)).unwrap();
        assert_eq!([picture.width, picture.height], [640, 400]);
        assert!(
            coloured(&picture) > 20_000,
            "{name}: {}",
            coloured(&picture)
        );
    }
    fs::remove_dir_all(folder).unwrap();
}
