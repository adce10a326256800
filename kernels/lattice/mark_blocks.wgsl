// Gardner & Sitar 2018, section 3.4: which walls have a block within five cells. The gap between them is too narrow for a law of the
// wall.
// needs wall_cells, psm_planes, psm_storage

override BRICK_X: u32;
override BRICK_Y: u32;
override BRICK_Z: u32;

// Of each brick its place among those that blocks reach, from 1; 0 for the others.
@group(0) @binding(41) var<storage, read> psm_slots: array<u32>;
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
    let size = vec3(BRICK_X, BRICK_Y, BRICK_Z);
    let lane = cell.y / NY + cell.z / NZ;
    let at = vec3(cell.x, cell.y % NY, cell.z % NZ);
    let brick = at / size;
    let bricks_x = (NX + BRICK_X - 1u) / BRICK_X;
    let bricks_y = (NY + BRICK_Y - 1u) / BRICK_Y;
    let slot = psm_slots[brick.x + bricks_x * (brick.y + bricks_y * brick.z)];
    if (slot == 0u) {
        return false;
    }
    let inner = at % size;
    let element = inner.x + BRICK_X * (inner.y + BRICK_Y * inner.z);
    // A sum with its code is above zero where there is solid: see encode_sum.
    return read_psm(PLANE_SUM, slot - 1u, element * LANES_OF_ELEMENT + lane) > 0.0;
}
