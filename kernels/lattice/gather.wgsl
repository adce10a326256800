// The values of listed domain cells, in the order of the list.
// needs scalar_grid

@group(0) @binding(50) var<storage, read> gather_from: array<f32>;
// Indices of the cells, x fastest.
@group(0) @binding(51) var<storage, read> listed: array<u32>;
@group(0) @binding(54) var<storage, read_write> gathered: array<f32>;

@compute @workgroup_size(64)
fn gather(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n < arrayLength(&listed)) {
        gathered[n] = gather_from[listed[n]];
    }
}
