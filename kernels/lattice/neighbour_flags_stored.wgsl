// The flags of a cell, as cell_flags_stored.wgsl explains them.
// needs scalar_grid

@group(0) @binding(32) var<storage, read> flags: array<u32>;

fn flags_of(cell: vec3<u32>) -> u32 {
    let at = element_and_lane(cell);
    return (flags[at.x] >> (8u * at.y)) & 255u;
}
