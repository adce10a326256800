// Guo, Zheng & Shi 2002: density and velocity of each domain cell, rho = 1 + sum f, rho u = sum c f + F/2.
// needs scalar_grid, incoming, $cell_force, $neighbour_flags

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
    let cell = domain_cell(n);
    var excess = 0.0;
    var u = vec3(0.0);
    if ((flags_of(cell) & 128u) == 0u) {
        let at = neighbourhood(cell);
        excess = read_incoming(at, 0u);
        for (var q = 1u; q < 27u; q++) { // unroll
            let f = read_incoming(at, q);
            excess += f;
            u += f * vec3<f32>(C[q]);
        }
        u = (u + 0.5 * cell_force(cell)) / (1.0 + excess);
    }
    density_out[n] = excess;
    velocity_x_out[n] = u.x;
    velocity_y_out[n] = u.y;
    velocity_z_out[n] = u.z;
}
