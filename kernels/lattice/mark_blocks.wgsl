// Gardner & Sitar 2018, section 3.4: marks the walls with a block within five cells. The gap between them is too narrow for a
// law of the wall.
// needs wall_cells, psm_places, psm_planes, psm_storage

@group(0) @binding(42) var<storage, read_write> wall_blocks: array<u32>;

@compute @workgroup_size(64)
fn mark_blocks(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= arrayLength(&wall_cells)) {
        return;
    }
    var found = 0u;
    for (var layer = 0u; layer < 5u; layer++) {
        found |= u32(solid_in(layer_cell(wall_cells[n], layer)));
    }
    wall_blocks[n] = found;
}

fn solid_in(cell: vec3<u32>) -> bool {
    let at = psm_place(cell);
    // A sum with its code is positive in a cell with solid: see encode_sum.
    return at.x > 0u && read_psm(PLANE_SUM, at.x - 1u, at.y) > 0.0;
}
