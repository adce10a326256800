//! Data that the host writes have the layout of the kernels.

use crate::tiling::grid;
use riprap::{
    gpu::{
        layout::check,
        link::{Program, source},
    },
    psm::{
        CellMapping, FACE_LOAD, FACING_SUM, FaceJob, INTERIOR, INTERIOR_SUM, JOINT_SUM, Motion,
        NEAR, OBLIQUE_SHIFT, Part, SHARED_SUM, TOUCHES, Tile, WRENCH, reduce_faces,
    },
};
use std::mem::offset_of;

#[test]
fn structures() {
    let tables = Program::new("tables").link().unwrap().module;
    let tile = [
        ("cell", offset_of!(Tile, cell)),
        ("part", offset_of!(Tile, part)),
        ("block", offset_of!(Tile, block)),
        ("slot", offset_of!(Tile, slot)),
        ("lane", offset_of!(Tile, lane)),
        ("inside", offset_of!(Tile, inside)),
    ];
    check::<Tile>(&tables, "Tile", &tile).unwrap();
    let part = [
        ("base", offset_of!(Part, base)),
        ("first_face", offset_of!(Part, first_face)),
        ("fraction", offset_of!(Part, fraction)),
        ("faces", offset_of!(Part, faces)),
        ("low", offset_of!(Part, low)),
        ("radius", offset_of!(Part, radius)),
        ("high", offset_of!(Part, high)),
        ("block", offset_of!(Part, block)),
    ];
    check::<Part>(&tables, "Part", &part).unwrap();
    let motion = [
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
    check::<Motion>(&tables, "Motion", &motion).unwrap();
    let job = [
        ("tile", offset_of!(FaceJob, tile)),
        ("face", offset_of!(FaceJob, face)),
        ("layer", offset_of!(FaceJob, layer)),
    ];
    let linked = reduce_faces(&grid([8; 3], 1, [4; 3]), CellMapping::Parallel)
        .link()
        .unwrap();
    check::<FaceJob>(&linked.module, "FaceJob", &job).unwrap();
}

/// Marks and sizes that host and kernels define under the same name.
#[test]
fn constants() {
    let there = |name: &str| -> f32 {
        let texts = ["tables", "psm_planes", "effective_surface"].map(|file| source(file).unwrap());
        let text = texts.join("\n");
        let mut values = text.lines().filter_map(|line| {
            let (declared, value) = line.strip_prefix("const ")?.split_once(" = ")?;
            (declared == name).then_some(value)
        });
        let value = values.next().unwrap().trim_end_matches(['u', ';']);
        value.parse().unwrap()
    };
    for (name, value) in [
        ("OBLIQUE_SHIFT", OBLIQUE_SHIFT),
        ("INTERIOR", INTERIOR),
        ("NEAR", NEAR),
        ("NEAR_SUM", NEAR),
        ("TOUCHES", TOUCHES),
        ("INTERIOR_SUM", INTERIOR_SUM),
        ("JOINT_SUM", JOINT_SUM),
        ("FACING_SUM", FACING_SUM),
        ("SHARED_SUM", SHARED_SUM),
        ("WRENCH", WRENCH as f32),
        ("FACE_LOAD", FACE_LOAD as f32),
    ] {
        assert_eq!(there(name), value, "{name}");
    }
}
