//! Corrupted meshes.

use super::{Dice, judge};
use riprap::{
    Result,
    geometry::{Polyhedron, TriangleMesh},
};
use std::path::{Path, PathBuf};

const COUNT: usize = 10_000;

/// Corners of a box and the two triangles of each face, counter-clockwise seen from outside.
const CORNERS: [[f32; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 2.0, 0.0],
    [0.0, 2.0, 0.0],
    [0.0, 0.0, 3.0],
    [1.0, 0.0, 3.0],
    [1.0, 2.0, 3.0],
    [0.0, 2.0, 3.0],
];
const TRIANGLES: [[usize; 3]; 12] = [
    [0, 2, 1],
    [0, 3, 2],
    [4, 5, 6],
    [4, 6, 7],
    [0, 1, 5],
    [0, 5, 4],
    [1, 2, 6],
    [1, 6, 5],
    [2, 3, 7],
    [2, 7, 6],
    [3, 0, 4],
    [3, 4, 7],
];

fn binary() -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes.extend((TRIANGLES.len() as u32).to_le_bytes());
    for triangle in TRIANGLES {
        bytes.extend([0; 12]);
        for x in triangle.iter().flat_map(|c| CORNERS[*c]) {
            bytes.extend(x.to_le_bytes());
        }
        bytes.extend([0; 2]);
    }
    bytes
}

fn ascii() -> Vec<u8> {
    let mut text = String::from("solid box\n");
    for triangle in TRIANGLES {
        text += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in triangle.map(|c| CORNERS[c]) {
            text += &format!("vertex {x} {y} {z}\n");
        }
        text += "endloop\nendfacet\n";
    }
    (text + "endsolid box\n").into_bytes()
}

fn obj() -> Vec<u8> {
    let mut text = String::from("o box\n");
    for [x, y, z] in CORNERS {
        text += &format!("v {x} {y} {z}\n");
    }
    for [a, b, c] in TRIANGLES {
        text += &format!("f {} {} {}\n", a + 1, b + 1, c + 1);
    }
    text.into_bytes()
}

/// Pieces inserted anywhere in the file.
const SCRAPS: [&[u8]; 16] = [
    b"nan",
    b"inf",
    b"-1e39",
    b"1e-45",
    b"99999999999",
    b"-1",
    b"0",
    b"f 1 2 3\n",
    b"f 1//1 2//2 9999//1\n",
    b"f -1 -2 -3\n",
    b"v 1e300 0 0\n",
    b"solid ",
    b"endsolid",
    b"\xff\xff\xff\xff",
    b"\x00\x00\x80\x7f",
    b"\n",
];

fn spoil(bytes: &mut Vec<u8>, dice: &mut Dice) {
    let at = dice.below(bytes.len().max(1));
    let to = (at + 1 + dice.below(60)).min(bytes.len());
    match dice.below(7) {
        _ if bytes.is_empty() => {}
        0 => bytes.truncate(at),
        1 => drop(bytes.drain(at..to)),
        2 => {
            let part = bytes[at..to].to_vec();
            let place = dice.below(bytes.len());
            bytes.splice(place..place, part);
        }
        3 => bytes[at] ^= 1 << dice.below(8),
        // Position of the number of triangles in binary files.
        4 if bytes.len() > 84 => {
            let count = dice.roll() as u32 >> dice.below(32);
            bytes[80..84].copy_from_slice(&count.to_le_bytes());
        }
        5 => {
            let scrap = dice.pick(&SCRAPS).iter().copied();
            bytes.splice(at..at, scrap);
        }
        _ => {
            let scrap = dice.pick(&SCRAPS);
            let end = (at + scrap.len()).min(bytes.len());
            bytes[at..end].copy_from_slice(&scrap[..end - at]);
        }
    }
}

fn read(path: &Path) -> Result<()> {
    let mesh = TriangleMesh::read(path, 1.0, [0.0; 3])?;
    // As a scene does: makes a block of the mesh, and a block of its corners.
    riprap::geometry::Shape::from_mesh(&mesh)?;
    Polyhedron::from_vertices(&mesh.vertices)?;
    Ok(())
}

fn bytes(input: &Vec<u8>) -> &[u8] {
    input
}

fn spoilt(extension: &'static str, right: &[Vec<u8>]) {
    let path: PathBuf = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("spoilt.{extension}"));
    for bytes in right {
        std::fs::write(&path, bytes).unwrap();
        read(&path).unwrap();
    }
    let mut dice = Dice(30);
    let right = right.to_vec();
    let inputs = (0..COUNT / 2).map(move |_| {
        let mut bytes = dice.pick(&right).clone();
        for _ in 0..=dice.below(3) {
            spoil(&mut bytes, &mut dice);
        }
        bytes
    });
    judge(inputs, bytes, move |bytes| {
        std::fs::write(&path, bytes).unwrap();
        read(&path)
    });
}

#[test]
fn spoilt_stl_files_are_read_or_refused_with_a_place() {
    spoilt("stl", &[binary(), ascii()]);
}

#[test]
fn spoilt_obj_files_are_read_or_refused_with_a_place() {
    spoilt("obj", &[obj()]);
}
