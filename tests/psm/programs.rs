//! The kernels are valid in all variants, and bind what they need and nothing else.

use riprap::{
    gpu::{kernel::bindings, link::Program},
    lattice::Grid,
    psm::{
        Forms, Walk, combine_parts, reduce_blocks, reduce_faces, reduce_tiles, sum_faces, voxelise,
        voxelise_edges,
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
        [
            "work",
            "tiles",
            "parts",
            "solid_fractions",
            "edges",
            "faces"
        ]
    );
    assert_eq!(
        names(&voxelise_edges(&grid, Forms::ALL), "voxelise_edges"),
        ["tiles", "parts", "solid_fractions", "edges", "faces"]
    );
    assert_eq!(
        names(&combine_parts(&grid, Walk::Parallel), "combine_parts"),
        [
            "work",
            "tiles",
            "motions",
            "lane_first",
            "lane_tiles",
            "solid_fractions",
            "psm_planes"
        ]
    );
    for walk in [Walk::Serial, Walk::Parallel] {
        assert_eq!(
            names(&reduce_tiles(&grid, walk), "reduce_tiles"),
            [
                "tiles",
                "motions",
                "solid_fractions",
                "psm_planes",
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
            "solid_fractions",
            "psm_planes",
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
