// Lehmann 2022, Computation 10(6):92: copies populations of one direction in canonical order out of the grid
// or into it: domain cells, x fastest, no parity, no padding, shifted by the weight, f32.
// needs scalar_grid, incoming

@group(0) @binding(50) var<storage, read> direction: u32;

@group(0) @binding(54) var<storage, read_write> canonical: array<f32>;

@compute @workgroup_size(64)
fn take_out(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n < CELLS_X * CELLS_Y * CELLS_Z) {
        canonical[n] = read_incoming(neighbourhood(domain_cell(n)), direction);
    }
}

@compute @workgroup_size(64)
fn bring_in(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n < CELLS_X * CELLS_Y * CELLS_Z) {
        write_incoming(neighbourhood(domain_cell(n)), direction, canonical[n]);
    }
}
