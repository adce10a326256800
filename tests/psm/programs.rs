//! The kernels are valid in all variants, and bind exactly what they need.

use riprap::{
    gpu::{kernel::bindings, link::Program},
    lattice::{Grid, SolidWeight},
    psm::{
        CellMapping, Forms, combine_parts, reduce_blocks, reduce_faces, reduce_tiles, sum_faces,
        voxelise, voxelise_edges,
    },
};

const EXACT: SolidWeight = SolidWeight::Exact;

/// The names of the bindings of a kernel.
fn names(program: &Program, entry: &str) -> String {
    let linked = program.link().unwrap();
    let bindings = bindings(&linked, entry).unwrap();
    let names: Vec<_> = bindings.into_iter().map(|b| b.name).collect();
    names.join(" ")
}

/// WebGPU guarantees 8 storage buffers.
#[test]
fn bindings_by_name() {
    let grid = Grid {
        cells: [8; 3],
        elements: [8, 8, 4],
        lanes: 2,
        lane_axis: 2,
        brick: [4; 3],
    };
    let programs = [
        (
            "voxelise",
            voxelise(&grid, CellMapping::Serial, Forms::ALL, EXACT),
        ),
        ("voxelise_edges", voxelise_edges(&grid, Forms::ALL, EXACT)),
        ("combine_parts", combine_parts(&grid, CellMapping::Parallel)),
        ("reduce_tiles", reduce_tiles(&grid, CellMapping::Serial)),
        ("reduce_tiles", reduce_tiles(&grid, CellMapping::Parallel)),
        ("reduce_faces", reduce_faces(&grid, CellMapping::Serial)),
        ("reduce_faces", reduce_faces(&grid, CellMapping::Parallel)),
        ("sum_faces", sum_faces()),
        ("reduce_blocks", reduce_blocks()),
    ];
    let told = programs.map(|(entry, program)| format!("{entry}: {}", names(&program, entry)));
    insta::assert_snapshot!(told.join("\n"));
}
