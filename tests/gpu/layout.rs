//! Data that the host writes and reads have the layout of the kernels.

use riprap::{
    Error,
    gpu::{
        layout::check,
        link::{Linked, Program, source},
    },
    lattice::{
        BlockFace, BrickKind, C, CellPass, FaceCell, FaceMode, Link, MovingCell, OpenFace, Setup,
        StatisticsPass, TurbulentFace, WallCell, WallStress, collide_stream, single_cells,
    },
};
use std::mem::offset_of;

fn linked(entry: &str) -> Linked {
    let setup = Setup::periodic([4; 3], 0.1);
    let program = single_cells(&setup, 1, entry).slot("sample", "sample_populations");
    program.link().unwrap()
}

#[test]
fn structures_of_the_lattice() {
    // A vector in WGSL.
    let link = [
        offset_of!(Link, from),
        offset_of!(Link, to),
        offset_of!(Link, directions),
        offset_of!(Link, step),
        size_of::<Link>(),
    ];
    assert_eq!(link, [0, 4, 8, 12, 16]);
    let through = offset_of!(MovingCell, through);
    let moving = [
        ("cell", offset_of!(MovingCell, cell)),
        ("through_x", through),
        ("through_y", through + 4),
        ("through_z", through + 8),
    ];
    check::<MovingCell>(&linked("moving_wall").module, "MovingCell", &moving).unwrap();
    let mode = [
        ("a", offset_of!(FaceMode, a)),
        ("lower", offset_of!(FaceMode, lower)),
        ("b", offset_of!(FaceMode, b)),
        ("upper", offset_of!(FaceMode, upper)),
        ("mean", offset_of!(FaceMode, mean)),
        ("normal", offset_of!(FaceMode, normal)),
        ("phase", offset_of!(FaceMode, phase)),
    ];
    let face = [
        ("modes", offset_of!(TurbulentFace, modes)),
        ("axis", offset_of!(TurbulentFace, axis)),
        ("advance", offset_of!(TurbulentFace, advance)),
        ("intensity", offset_of!(TurbulentFace, intensity)),
    ];
    let turbulence = linked("synthetic_turbulence").module;
    check::<FaceMode>(&turbulence, "Mode", &mode).unwrap();
    check::<TurbulentFace>(&turbulence, "TurbulentFace", &face).unwrap();
    let wall = [
        ("cell", offset_of!(WallCell, cell)),
        ("face", offset_of!(WallCell, face)),
        ("layers", offset_of!(WallCell, layers)),
        ("roughness", offset_of!(WallCell, roughness)),
    ];
    let stress = [
        ("stress", offset_of!(WallStress, stress)),
        ("friction", offset_of!(WallStress, friction)),
        ("share", offset_of!(WallStress, share)),
    ];
    let walls = linked("wall_model").module;
    check::<WallCell>(&walls, "WallCell", &wall).unwrap();
    check::<WallStress>(&walls, "WallStress", &stress).unwrap();
    let face = [
        ("cell", offset_of!(BlockFace, cell)),
        ("face", offset_of!(BlockFace, face)),
        ("friction", offset_of!(BlockFace, friction)),
        ("share", offset_of!(BlockFace, share)),
        ("stress", offset_of!(BlockFace, stress)),
        ("fraction", offset_of!(BlockFace, fraction)),
        ("normal", offset_of!(BlockFace, normal)),
        ("area", offset_of!(BlockFace, area)),
    ];
    let blocks = linked("block_friction").module;
    check::<BlockFace>(&blocks, "BlockFace", &face).unwrap();
    let cell = [
        ("cell", offset_of!(FaceCell, cell)),
        ("inner", offset_of!(FaceCell, inner)),
        ("entering", offset_of!(FaceCell, entering)),
        ("face", offset_of!(FaceCell, face)),
        ("turn", offset_of!(FaceCell, turn)),
    ];
    let pass = [
        ("odd", offset_of!(CellPass, odd)),
        ("half", offset_of!(CellPass, half)),
        ("first", offset_of!(CellPass, first)),
        ("end", offset_of!(CellPass, end)),
    ];
    let face = [
        ("normal", offset_of!(OpenFace, normal)),
        ("density", offset_of!(OpenFace, density)),
        ("hold", offset_of!(OpenFace, hold)),
        ("integral", offset_of!(OpenFace, integral)),
        ("gradient", offset_of!(OpenFace, gradient)),
    ];
    for entry in ["pressure_face", "outflow"] {
        let module = linked(entry).module;
        check::<FaceCell>(&module, "FaceCell", &cell).unwrap();
        check::<CellPass>(&module, "CellPass", &pass).unwrap();
        check::<OpenFace>(&module, "OpenFace", &face).unwrap();
    }
    let statistics = [
        ("plane", offset_of!(StatisticsPass, plane)),
        ("samples", offset_of!(StatisticsPass, samples)),
        ("weight", offset_of!(StatisticsPass, weight)),
        ("pad", offset_of!(StatisticsPass, pad)),
    ];
    let module = linked("statistics").module;
    check::<StatisticsPass>(&module, "StatisticsPass", &statistics).unwrap();
    // The host reads four words: steps after an even one, after an odd one, first bad step and cell.
    let setup = Setup::periodic([4; 3], 0.1);
    let step = collide_stream(&setup, 1, BrickKind::All).link().unwrap();
    let guard = [("even", 0), ("odd", 4), ("even_cell", 8), ("odd_cell", 12)];
    check::<[u32; 4]>(&step.module, "Guard", &guard).unwrap();
    // It reads eight numbers per invocation.
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
    let sums: Vec<_> = names.into_iter().zip((0..).step_by(4)).collect();
    check::<[f32; 8]>(&linked("sums").module, "Sums", &sums).unwrap();
}

/// The host counts links along the directions in which the kernels stream.
#[test]
fn directions() {
    let text = source("lattice").unwrap();
    let (_, list) = text.split_once("const C = array<vec3<i32>, 27>(").unwrap();
    let (list, _) = list.split_once(";").unwrap();
    let there: Vec<[i32; 3]> = list
        .split("vec3(")
        .skip(1)
        .map(|vector| {
            let (vector, _) = vector.split_once(')').unwrap();
            let c: Vec<i32> = vector
                .split(',')
                .map(|c| c.trim().parse().unwrap())
                .collect();
            c.try_into().unwrap()
        })
        .collect();
    assert_eq!(there, C);
}

/// vec3 is aligned to 16 bytes in WGSL and to 4 on the host. This common mismatch is detected.
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
