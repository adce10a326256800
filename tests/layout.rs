//! What the host writes and reads lies as the kernels have it.

use riprap::{
    Error,
    lattice::{FaceCell, Link, MovingCell, Setup, single_cells},
    layout::check,
    link::{Linked, Program},
};
use std::mem::offset_of;

fn linked(entry: &str) -> Linked {
    let setup = Setup::periodic([4; 3], 0.1);
    single_cells(&setup, 1, entry).link().unwrap()
}

#[test]
fn links() {
    let fields = [
        ("scalar_from", offset_of!(Link, from)),
        ("scalar_to", offset_of!(Link, to)),
        ("directions", offset_of!(Link, directions)),
    ];
    check::<Link>(&linked("links").module, "Link", &fields).unwrap();
}

#[test]
fn moving_cells() {
    let through = offset_of!(MovingCell, through);
    let fields = [
        ("cell", offset_of!(MovingCell, cell)),
        ("through_x", through),
        ("through_y", through + 4),
        ("through_z", through + 8),
    ];
    check::<MovingCell>(&linked("moving_wall").module, "MovingCell", &fields).unwrap();
}

#[test]
fn face_cells() {
    let fields = [
        ("cell", offset_of!(FaceCell, cell)),
        ("inner", offset_of!(FaceCell, inner)),
        ("entering", offset_of!(FaceCell, entering)),
    ];
    for entry in ["pressure_face", "outflow"] {
        check::<FaceCell>(&linked(entry).module, "FaceCell", &fields).unwrap();
    }
}

/// The host reads four words: steps after an even one, after an odd one, first bad step and cell.
#[test]
fn the_guard() {
    let setup = Setup::periodic([4; 3], 0.1);
    let linked = riprap::lattice::collide_stream(&setup, 1, riprap::lattice::Reach::All)
        .link()
        .unwrap();
    let fields = [("even", 0), ("odd", 4), ("even_cell", 8), ("odd_cell", 12)];
    check::<[u32; 4]>(&linked.module, "Guard", &fields).unwrap();
}

/// The host reads eight numbers an invocation.
#[test]
fn sums() {
    let names = [
        "excess",
        "momentum_x",
        "momentum_y",
        "momentum_z",
        "kinetic_energy",
        "enstrophy",
        "max_speed_squared",
        "fluid_cells",
    ];
    let fields: Vec<_> = names.into_iter().zip((0..).step_by(4)).collect();
    check::<[f32; 8]>(&linked("sums").module, "Sums", &fields).unwrap();
}

/// vec3 is aligned to 16 bytes in WGSL and to 4 on the host: the classic mistake is found.
#[test]
fn a_padded_vector_is_refused() {
    #[repr(C)]
    struct Particle {
        mass: f32,
        velocity: [f32; 3],
    }
    let wgsl = "struct Particle { mass: f32, velocity: vec3<f32> }";
    let linked = Program::new("particle")
        .text("particle", wgsl)
        .link()
        .unwrap();
    let fields = [
        ("mass", offset_of!(Particle, mass)),
        ("velocity", offset_of!(Particle, velocity)),
    ];
    let refused = check::<Particle>(&linked.module, "Particle", &fields).unwrap_err();
    assert!(matches!(refused, Error::Layout { .. }), "{refused}");
    assert!(refused.to_string().contains("32 bytes"), "{refused}");
    let missing = check::<Particle>(&linked.module, "Fluid", &fields).unwrap_err();
    assert!(missing.to_string().contains("no such struct"), "{missing}");
}
