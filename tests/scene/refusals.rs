//! Refusals and warnings: the cases of `refusals.txt`, each a scene of this folder with lines removed (`-`) and lines put in
//! their place or at the end (`+`). The snapshot has the place, the key and the message.

use riprap::{
    Error, Result,
    error::Overlap,
    scene::{Advice, Scene, build::block_setup},
    units::Units,
};

use crate::{
    CHANNEL,
    blocks::{BAR, CUBE},
    particles::TANK,
    read, refused,
    warnings::STONE,
};

/// A layer of fluid below a lid that moves.
const LAYER: &str = r#"
domain = { size = [0.01, 0.01, 0.01], cell = 1e-3 }
run.steps = 1
boundaries.z_min.kind = "wall"
boundaries.z_max = { kind = "wall", velocity = [0.01, 0, 0] }
fluid.viscosity = 1e-5
"#;

/// The warnings of all checks of a scene that need no device; keys are checked for steps of 1 ms.
fn prepare(text: &str) -> Result<Advice> {
    let scene = read(text)?;
    block_setup(&scene)?;
    let mut warnings = scene.suspicious_keys(1e-3);
    if scene.has_fluid() {
        let units = Units::of(&scene);
        if !scene.has_particles() {
            scene.solid_mask()?;
            scene.initial_fields()?;
        }
        warnings.extend(scene.advise(&units?)?);
    }
    Ok(warnings)
}

/// A scene of this folder, changed by the lines of a case.
fn changed(case: &str) -> String {
    let mut lines = case.lines();
    let base = match lines.next() {
        Some("channel") => CHANNEL,
        Some("cube") => CUBE,
        Some("tank") => TANK,
        Some("bar") => BAR,
        Some("layer") => LAYER,
        Some("stone") => STONE,
        _ => "",
    };
    let marked = |mark| {
        let lines = case.lines().filter_map(move |line| line.strip_prefix(mark));
        lines.map(|line| format!("{line}\n")).collect::<String>()
    };
    let (old, new) = (marked('-'), marked('+'));
    if old.is_empty() {
        return format!("{base}{new}");
    }
    assert_eq!(base.matches(&old).count(), 1, "{case}");
    base.replace(&old, &new)
}

#[test]
fn refusals_and_warnings_name_the_key_and_a_remedy() {
    let mut told = String::new();
    let cases = include_str!("refusals.txt")
        .lines()
        .filter(|line| !line.starts_with('#'));
    let cases = cases.collect::<Vec<_>>().join("\n");
    for case in cases.split("== ").skip(1) {
        told += &format!("{}\n", case.trim_end());
        told += &match prepare(&changed(case)) {
            Err(error) => format!("  {error}\n\n"),
            Ok(warnings) if warnings.is_empty() => "  is right\n\n".into(),
            Ok(warnings) => {
                let lines = warnings
                    .iter()
                    .map(|warning| format!("  warning {warning}\n"));
                lines.collect::<String>() + "\n"
            }
        };
    }
    insta::assert_snapshot!(told);
}

#[test]
fn a_missing_file_is_named() {
    refused(
        Scene::from_file("no/such/scene.toml"),
        &["no/such/scene.toml", "check the path"],
    );
}

proptest::proptest! {
    /// A scene with a piece cut out or duplicated is read or refused, without a panic.
    #[test]
    fn no_mutilated_scene_panics(from in 0..450_usize, length in 0..60_usize, double: bool) {
        let text = TANK;
        let skipped = text.find("[domain]").unwrap() + from;
        let piece: String = text.chars().skip(skipped).take(length).collect();
        let broken = if double {
            text.replacen(&piece, &piece.repeat(2), 1)
        } else {
            text.replacen(&piece, "", 1)
        };
        let _ = read(&broken);
    }
}

/// Errors that only name a block, and errors of overlapping blocks, get the line of the table of the block.
#[test]
fn blocks_have_the_line_of_their_table() {
    let text = "[[blocks]]\nname = \"a\"\n[[blocks]]\nname = \"tower\"\nrepeat = 3\n";
    let located = |error| Scene::locate(error, text, "pile.toml").to_string();
    let outside = |name: &str| located(Error::scene(format!("block {name}"), "lies outside"));
    assert!(
        outside("a").starts_with("pile.toml:1:1: block a"),
        "{}",
        outside("a")
    );
    assert!(
        outside("tower_2").starts_with("pile.toml:3:1:"),
        "{}",
        outside("tower_2")
    );
    assert!(
        outside("towers").starts_with("pile.toml: block"),
        "{}",
        outside("towers")
    );
    let pairs = vec![Overlap {
        first: "blocks[0] (a)".into(),
        second: "blocks[2] (tower_2)".into(),
        depth: 0.1,
    }];
    let told = located(Error::Overlaps { pairs });
    assert!(
        told.contains("blocks[0] (a) of pile.toml:1") && told.contains("(tower_2) of pile.toml:3"),
        "{told}"
    );
}
