//! The kernels are valid in all variants, and bind what they need and nothing else.

use riprap::{
    gpu::{kernel::bindings, link::Program},
    lattice::Grid,
    psm::{
        Forms, Walk, reduce_blocks, reduce_faces, reduce_tiles, saturate_cells, sum_faces,
        voxelise, voxelise_edges,
    },
};

fn names(program: &Program, entry: &str) -> Vec<String> {
    let linked = program.link().unwrap();
    let bindings = bindings(&linked, entry).unwrap();
    bindings.into_iter().map(|b| b.name).collect()
}

/// WebGPU promises 8 storage buffers.
#[test]
fn bindings_by_name() {
    let grid = Grid {
        cells: [8; 3],
        elements: [8, 8, 4],
        lanes: 2,
        brick: [4; 3],
    };
    assert_eq!(
        names(&voxelise(&grid, Walk::Serial, Forms::ALL), "voxelise"),
        ["work", "tiles", "parts", "shares", "edges", "faces"]
    );
    assert_eq!(
        names(&voxelise_edges(&grid, Forms::ALL), "voxelise_edges"),
        ["tiles", "parts", "shares", "edges", "faces"]
    );
    assert_eq!(
        names(&saturate_cells(&grid, Walk::Parallel), "saturate_cells"),
        [
            "work",
            "tiles",
            "motions",
            "lane_first",
            "lane_tiles",
            "shares",
            "saturation"
        ]
    );
    for walk in [Walk::Serial, Walk::Parallel] {
        assert_eq!(
            names(&reduce_tiles(&grid, walk), "reduce_tiles"),
            [
                "tiles",
                "motions",
                "shares",
                "saturation",
                "block_first",
                "partials"
            ]
        );
    }
    assert_eq!(
        names(&reduce_faces(&grid), "reduce_faces"),
        [
            "tiles",
            "motions",
            "shares",
            "saturation",
            "jobs",
            "parts",
            "faces",
            "face_partials"
        ]
    );
    assert_eq!(
        names(&sum_faces(), "sum_faces"),
        ["face_first", "face_partials", "face_loads"]
    );
    assert_eq!(
        names(&reduce_blocks(), "reduce_blocks"),
        ["block_first", "partials", "wrenches"]
    );
}
