// Ladd 1994, J. Fluid Mech. 271:285, eq. 4.4: half-way bounce-back at a wall that moves with u_w, a velocity
// inlet included: f_opposite = f* - 6 w rho (c.u_w), c into the wall. rho is the density that the
// cell has with these populations: rho = (1 + known + reflected) / (1 + 6 sum w c.u_w).
// needs scalar_grid, moving_cells, incoming, weights

// For each moving cell the velocities of its faces normal to x, y, z.
@group(0) @binding(41) var<storage, read> wall_velocity: array<f32>;

@compute @workgroup_size(64)
fn move_wall(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = cell_pass.first + invocation(group, groups, local);
    if (n >= cell_pass.end) {
        return;
    }
    let here = moving_cells[n];
    let cell = neighbourhood(padded_cell(here.cell));
    let moving = here.through_x | here.through_y | here.through_z;
    let u_x = face_velocity(n, 0u);
    let u_y = face_velocity(n, 1u);
    let u_z = face_velocity(n, 2u);
    // For direction q, the reflected or the known population, and 6 w (c.u_w) of the face that q leads through.
    var f: array<f32, 27>;
    var push: array<f32, 27>;
    var sum = 1.0 + read_incoming(cell, 0u);
    var flux = 0.0;
    for (var q = 1u; q < 27u; q++) { // unroll
        let known = incoming(cell, opposite(q));
        let reflected = outgoing(cell, q);
        let through = (moving & (1u << q)) != 0u;
        f[q] = read_scalar(
            select(known.direction, reflected.direction, through),
            select(known.scalar, reflected.scalar, through),
        );
        let u = select(select(u_z, u_y, (here.through_y & (1u << q)) != 0u), u_x, (here.through_x & (1u << q)) != 0u);
        push[q] = 6.0 * weight(q) * dot(vec3<f32>(C[q]), u);
        sum += f[q];
        if (through) {
            flux += push[q];
        }
    }
    let rho = sum / (1.0 + flux);
    for (var q = 1u; q < 27u; q++) { // unroll
        if ((moving & (1u << q)) != 0u) {
            write_incoming(cell, opposite(q), f[q] - rho * push[q]);
        }
    }
}

// Velocity of the face normal to an axis.
fn face_velocity(n: u32, axis: u32) -> vec3<f32> {
    let at = 9u * n + 3u * axis;
    return vec3(wall_velocity[at], wall_velocity[at + 1u], wall_velocity[at + 2u]);
}
