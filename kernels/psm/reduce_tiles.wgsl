// Gardner & Sitar 2018, eqs. 11-12: the sum over the cells of the tiles of each segment, and nothing that depends on the
// order in which the device works.
// needs cell_load, $tile_sum

// WRENCH a segment.
@group(0) @binding(5) var<storage, read_write> partials: array<f32>;

@compute @workgroup_size(64)
fn reduce_tiles(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    sum_segment(workgroup_index(group, groups), local);
}
