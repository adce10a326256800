//! Corrupted versions of the shipped scenes.

use super::{Dice, judge};
use riprap::{
    Result,
    scene::{
        Scene,
        build::{block_setup, lattice_setup, particle_setup},
    },
    units::Units,
};
use std::path::{Path, PathBuf};

const COUNT: usize = 10_000;
/// Largest number of cells of a lattice that is set up on the host.
const MOST_CELLS: f64 = 1e5;
/// Largest number of particles that are placed.
const MOST_PARTICLES: f64 = 2e4;
/// Largest number of blocks in arrays that are created.
const MOST_COPIES: f64 = 1e3;

/// Replacements of values.
const VALUES: [&str; 34] = [
    "0",
    "-1",
    "1",
    "-0.0",
    "1e-300",
    "1e300",
    "-1e300",
    "1e-30",
    "1e18",
    "nan",
    "inf",
    "-inf",
    "4294967296",
    "9223372036854775807",
    "-9223372036854775808",
    "true",
    "\"\"",
    "\"nan\"",
    "\"1/0\"",
    "\"x^x^x^x\"",
    "\"((((((((((x\"",
    "\"größe\"",
    "\"\u{0}\"",
    "\"🪨\"",
    "[]",
    "[0]",
    "[nan, nan, nan]",
    "[1e300, 1e300, 1e300]",
    "[[]]",
    "{}",
    "{ kind = \"wall\" }",
    "{ kind = \"\" }",
    "1979-05-27",
    "\"../../../../etc/passwd\"",
];
/// Pieces inserted anywhere in the text.
const SCRAPS: [&str; 14] = [
    "=",
    "[[",
    "]]",
    "[",
    "]",
    "{",
    "}",
    "\"",
    "\n",
    "é",
    "\u{202e}",
    "'''",
    "[blocks.blocks]\n",
    "\r",
];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes")
}

/// Names and texts of the shipped scenes, in the order of the names.
fn shipped() -> Vec<(String, String)> {
    let files = std::fs::read_dir(folder()).unwrap();
    let mut all: Vec<_> = files
        .map(|file| file.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .map(|path| {
            let name = path.file_name().unwrap().to_str().unwrap().to_owned();
            (name, std::fs::read_to_string(&path).unwrap())
        })
        .collect();
    all.sort();
    all
}

/// The byte ranges of numbers and words after `=`, `[` or `,`.
fn values(text: &str) -> Vec<(usize, usize)> {
    let bytes = text.as_bytes();
    let mut found = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        if bytes[at] == b'#' {
            at += text[at..].find('\n').unwrap_or(text.len() - at);
            continue;
        }
        if !matches!(bytes[at], b'=' | b'[' | b',') {
            at += 1;
            continue;
        }
        let mut begin = at + 1;
        while bytes.get(begin) == Some(&b' ') {
            begin += 1;
        }
        let mut end = begin;
        while bytes
            .get(end)
            .is_some_and(|b| b.is_ascii_alphanumeric() || b"\"'_.+-*/()^ ".contains(b))
        {
            end += 1;
        }
        if end > begin {
            found.push((begin, end));
        }
        at = end.max(at + 1);
    }
    found
}

fn boundary(text: &str, dice: &mut Dice) -> usize {
    let mut at = dice.below(text.len() + 1);
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

fn spoil(text: &str, dice: &mut Dice) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    match dice.below(10) {
        0 => {
            lines.remove(dice.below(lines.len()));
            lines.join("\n")
        }
        1 => {
            let line = *dice.pick(&lines);
            lines.insert(dice.below(lines.len()), line);
            lines.join("\n")
        }
        2 => {
            let (a, b) = (dice.below(lines.len()), dice.below(lines.len()));
            lines.swap(a, b);
            lines.join("\n")
        }
        3 => text[..boundary(text, dice)].to_owned(),
        4 => {
            let at = boundary(text, dice);
            format!("{}{}{}", &text[..at], dice.pick(&SCRAPS), &text[at..])
        }
        5 => {
            // A typing error in one letter.
            let at = boundary(text, dice);
            let next = text[at..].chars().next().map_or(0, char::len_utf8);
            format!("{}{}", &text[..at], &text[at + next..])
        }
        _ => {
            let all = values(text);
            if all.is_empty() {
                return text.to_owned();
            }
            let (from, to) = *dice.pick(&all);
            format!("{}{}{}", &text[..from], dice.pick(&VALUES), &text[to..])
        }
    }
}

/// Does everything that is done with a small scene before a device is needed; the `deep` part only for one of four, since
/// it takes longer than all else.
fn read(name: &str, text: &str, deep: bool) -> Result<()> {
    let scene = Scene::from_toml(text, &folder(), name)?;
    if !deep {
        return Ok(());
    }
    let copies: f64 = scene
        .blocks
        .iter()
        .map(|block| {
            block
                .repeat
                .iter()
                .map(|r| f64::from(r.count))
                .product::<f64>()
        })
        .sum();
    if !scene.rock_masses.is_empty() || copies >= MOST_COPIES {
        return Ok(());
    }
    let blocks = block_setup(&scene)?;
    if let Some(particles) = &scene.particles {
        let [x, y, z] = scene.domain.size.map(|size| size / particles.spacing);
        let count = if particles.plane { x * z } else { x * y * z };
        if count < MOST_PARTICLES {
            particle_setup(&scene, &blocks)?;
        }
    }
    if scene.has_fluid() && !scene.has_particles() {
        let units = Units::of(&scene)?;
        scene.advise(&units)?;
        if scene.cells().iter().map(|n| f64::from(*n)).product::<f64>() < MOST_CELLS {
            lattice_setup(&scene, &units, None)?;
        }
    }
    Ok(())
}

/// The text of an input.
fn bytes(input: &(String, String, bool)) -> &[u8] {
    input.1.as_bytes()
}

#[test]
fn spoilt_scenes_are_read_or_refused_with_a_place() {
    let shipped = shipped();
    for (name, text) in &shipped {
        assert!(read(name, text, true).is_ok(), "{name} itself");
    }
    let mut dice = Dice(20);
    let inputs = (0..COUNT).map(move |number| {
        let (name, text) = dice.pick(&shipped);
        let mut text = text.clone();
        for _ in 0..=dice.below(3) {
            if !text.is_empty() && text.lines().next().is_some() {
                text = spoil(&text, &mut dice);
            }
        }
        (name.clone(), text, number % 4 == 0)
    });
    judge(inputs, bytes, |(name, text, deep)| read(name, text, *deep));
}
