//! What the host writes lies as the kernels have it.

use riprap::{
    gpu::{
        layout::check,
        link::{Linked, Program, source},
    },
    lattice::Grid,
    psm::{
        FACE_LOAD, FaceJob, INTERIOR, INTERIOR_SUM, JOINT_SUM, Motion, NEAR, PLANES, Part, TOUCHES,
        Tile, WRENCH, reduce_faces,
    },
};
use std::mem::offset_of;

fn tables() -> Linked {
    Program::new("tables").link().unwrap()
}

#[test]
fn tiles() {
    let fields = [
        ("cell", offset_of!(Tile, cell)),
        ("part", offset_of!(Tile, part)),
        ("block", offset_of!(Tile, block)),
        ("slot", offset_of!(Tile, slot)),
        ("lane", offset_of!(Tile, lane)),
        ("inside", offset_of!(Tile, inside)),
    ];
    check::<Tile>(&tables().module, "Tile", &fields).unwrap();
}

#[test]
fn parts() {
    let fields = [
        ("base", offset_of!(Part, base)),
        ("first_face", offset_of!(Part, first_face)),
        ("fraction", offset_of!(Part, fraction)),
        ("faces", offset_of!(Part, faces)),
        ("low", offset_of!(Part, low)),
        ("radius", offset_of!(Part, radius)),
        ("high", offset_of!(Part, high)),
        ("block", offset_of!(Part, block)),
    ];
    check::<Part>(&tables().module, "Part", &fields).unwrap();
}

#[test]
fn motions() {
    let fields = [
        ("base", offset_of!(Motion, base)),
        ("pad0", offset_of!(Motion, pad0)),
        ("fraction", offset_of!(Motion, fraction)),
        ("pad1", offset_of!(Motion, pad1)),
        ("velocity", offset_of!(Motion, velocity)),
        ("pad2", offset_of!(Motion, pad2)),
        ("gradient_x", offset_of!(Motion, gradient_x)),
        ("pad3", offset_of!(Motion, pad3)),
        ("gradient_y", offset_of!(Motion, gradient_y)),
        ("pad4", offset_of!(Motion, pad4)),
        ("gradient_z", offset_of!(Motion, gradient_z)),
        ("pad5", offset_of!(Motion, pad5)),
    ];
    check::<Motion>(&tables().module, "Motion", &fields).unwrap();
}

#[test]
fn face_jobs() {
    let grid = Grid {
        cells: [8; 3],
        elements: [8; 3],
        lanes: 1,
        brick: [4; 3],
    };
    let fields = [
        ("tile", offset_of!(FaceJob, tile)),
        ("face", offset_of!(FaceJob, face)),
    ];
    let linked = reduce_faces(&grid).link().unwrap();
    check::<FaceJob>(&linked.module, "FaceJob", &fields).unwrap();
}

/// The marks and sizes that both sides know by name.
#[test]
fn constants() {
    let there = |name: &str| -> f32 {
        let texts = ["tables", "psm_planes"].map(|file| source(file).unwrap());
        let text = texts.join("\n");
        let mut values = text.lines().filter_map(|line| {
            let (declared, value) = line.strip_prefix("const ")?.split_once(" = ")?;
            (declared == name).then_some(value)
        });
        let value = values.next().unwrap().trim_end_matches(['u', ';']);
        value.parse().unwrap()
    };
    assert_eq!(there("INTERIOR"), INTERIOR);
    assert_eq!(there("NEAR"), NEAR);
    assert_eq!(there("NEAR_SUM"), NEAR);
    assert_eq!(there("TOUCHES"), TOUCHES);
    assert_eq!(there("INTERIOR_SUM"), INTERIOR_SUM);
    assert_eq!(there("JOINT_SUM"), JOINT_SUM);
    assert_eq!(there("PLANES"), PLANES as f32);
    assert_eq!(there("WRENCH"), WRENCH as f32);
    assert_eq!(there("FACE_LOAD"), FACE_LOAD as f32);
}
