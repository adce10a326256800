// Gardner & Sitar 2018, eqs. 11-12: the sum over the cells of the tiles of each segment, independent of the order in
// which the device executes.
// needs cell_load, $tile_sum

// WRENCH numbers per segment.
@group(0) @binding(5) var<storage, read_write> partials: array<f32>;

@compute @workgroup_size(64)
fn reduce_tiles(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    sum_segment(workgroup_index(group, groups), local);
}
