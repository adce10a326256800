// Guo, Zheng & Shi 2002: density and velocity of each domain cell.
// needs scalar_grid, cell_state

// Density minus one.
@group(0) @binding(50) var<storage, read_write> density_out: array<f32>;
@group(0) @binding(51) var<storage, read_write> velocity_x_out: array<f32>;
@group(0) @binding(52) var<storage, read_write> velocity_y_out: array<f32>;
@group(0) @binding(53) var<storage, read_write> velocity_z_out: array<f32>;

@compute @workgroup_size(64)
fn macroscopic(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= CELLS_X * CELLS_Y * CELLS_Z) {
        return;
    }
    let state = cell_state(domain_cell(n));
    density_out[n] = state.x;
    velocity_x_out[n] = state.y;
    velocity_y_out[n] = state.z;
    velocity_z_out[n] = state.w;
}
