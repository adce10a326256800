//! Text that does not follow the format is refused with line, column and a guess.

use riprap::{Error, error::Overlap, scene::Scene};

use crate::{changed, channel, read, refused};

#[test]
fn text_that_is_not_toml_names_line_and_column() {
    refused(
        read("[domain]\nsize = [1, 2\ncell = 1\n"),
        &["channel.toml:3:"],
    );
}

#[test]
fn unknown_keys_and_words_get_a_guess() {
    refused(
        changed("viscosity", "viscocity"),
        &[
            "channel.toml:6:1",
            "no key `viscocity`",
            "did you mean `viscosity`?",
            "density",
        ],
    );
    refused(
        channel("[numerics]\ncollision = \"hermit\"\n"),
        &[
            "channel.toml:10:13",
            "no word `hermit`",
            "did you mean `hermite`?",
            "bgk",
        ],
    );
    refused(
        channel("[boundaries]\nx_min = { kind = \"inlet\" }\n"),
        &[
            "channel.toml:10:18",
            "no word `inlet`",
            "possible are periodic, wall",
        ],
    );
    refused(
        channel("[[solids]]\nkind = \"sphere\"\ncentre = [0, 0, 0]\nradius = 1\n"),
        &["channel.toml:11:1", "did you mean `center`?"],
    );
    refused(
        channel(
            "[[probes]]\nname = \"p\"\nkind = \"point\"\nat = [0, 0, 0]\nfields = [\"presure\"]\n",
        ),
        &["channel.toml:13:", "did you mean `pressure`?"],
    );
    refused(
        channel("[outputs]\n"),
        &["channel.toml:9:", "did you mean `output`?"],
    );
}

#[test]
fn wrong_types_name_the_key() {
    refused(
        changed("1e-6", "\"thin\""),
        &["channel.toml:6:13", "fluid.viscosity", "expected a number"],
    );
    refused(
        changed("0.004]", "]"),
        &["channel.toml:3:", "domain.size", "has 2 values; give 3"],
    );
    refused(
        channel("[initial]\nvelocity = [true, 0, 0]\n"),
        &[
            "channel.toml:10:13",
            "initial.velocity",
            "a number or a formula",
        ],
    );
    refused(
        channel("[initial]\npressure = \"hydrostatics\"\n"),
        &[
            "channel.toml:10:12",
            "initial.pressure",
            "hydrostatic",
            "variable",
        ],
    );
    refused(
        changed("steps = 10", "steps = -1"),
        &["run.steps", "whole number from 0"],
    );
}

#[test]
fn missing_keys_are_named() {
    refused(
        changed("viscosity = 1e-6", ""),
        &["fluid", "`viscosity` is missing"],
    );
    refused(
        channel("[[solids]]\nkind = \"sphere\"\ncenter = [0, 0, 0]\n"),
        &["channel.toml:9:", "kind `sphere` needs the key `radius`"],
    );
    refused(
        channel("[[solids]]\nkind = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmin = [0, 0, 0]\n"),
        &[
            "channel.toml:9:",
            "`min` has no meaning for kind `sphere`",
            "center, radius",
        ],
    );
    refused(
        channel("[boundaries]\nx_min = { kind = \"free_slip\", pressure = 1 }\n"),
        &[
            "channel.toml:10:",
            "`pressure` has no meaning for kind `free_slip`",
        ],
    );
}

#[test]
fn formulas_that_do_not_parse_name_the_character() {
    refused(
        channel("[boundaries]\nx_min = { kind = \"velocity\", velocity = [\"1 + q\", 0, 0] }\n"),
        &[
            "channel.toml:10:42",
            "character 5",
            "no variable `q`",
            "x, y, z, t",
        ],
    );
    refused(
        channel("[initial]\nvelocity = [\"t\", 0, 0]\n"),
        &["channel.toml:10:12: initial.velocity", "uses t", "x, y, z"],
    );
}

#[test]
fn formulas_that_are_not_finite_name_the_point() {
    refused(
        channel(
            "[boundaries]\nx_min = { kind = \"velocity\", velocity = [\"1/y-1/y\", \"log(-y)\", 0] }\nx_max = { kind = \"pressure\" }\n",
        ),
        &[
            "channel.toml:10:",
            "boundaries.x_min.velocity[1]",
            "NaN at (0, 0.0005, 0.0005) m",
            "max(",
        ],
    );
    let scene = channel("[initial]\nvelocity = [\"sqrt(0.0011 - x)\", 0, 0]\n").unwrap();
    refused(
        scene.initial_fields(),
        &["initial.velocity[0]", "NaN at (0.0015, 0.0005, 0.0005) m"],
    );
    refused(
        channel("[initial]\npressure = 1e40\n"),
        &["initial.pressure", "finite"],
    );
}

#[test]
fn a_missing_file_is_named() {
    refused(
        Scene::from_file("no/such/scene.toml"),
        &["no/such/scene.toml", "check the path"],
    );
}

proptest::proptest! {
    /// A scene with a piece cut out or doubled is read or refused, never a panic.
    #[test]
    fn no_mutilated_scene_panics(from in 0..450_usize, length in 0..60_usize, double: bool) {
        let text = crate::particles::TANK;
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

#[test]
fn a_key_that_stands_twice_is_named() {
    refused(
        channel("[output]\nfields_every = 1\nfields_every = 2\n"),
        &[
            "channel.toml:11:1",
            "`fields_every` stands twice",
            "keep one",
        ],
    );
}

/// Errors that know only the name of a block find the table that makes it, and so do blocks that overlap.
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
