// Noble & Torczynski 1998, eq. 4: in a partially saturated cell the momentum of a step is that in its middle, after half of
// the body force on what is fluid, (1 - B) F, and half of what the solid does. A plane of cells then carries in a steady flow what
// crosses it, wherever solids are: exactly with the operator of Holdych; the others have a part of the body force more. Corrects what
// macroscopic.wgsl has written.
// needs scalar_grid, psm_planes, psm_storage, $cell_force

override BRICK_X: u32;
override BRICK_Y: u32;
override BRICK_Z: u32;

// Their number, and those that blocks reach.
@group(0) @binding(40) var<storage, read> bricks: array<u32>;
@group(0) @binding(50) var<storage, read> density: array<f32>;
@group(0) @binding(51) var<storage, read_write> velocity_x_out: array<f32>;
@group(0) @binding(52) var<storage, read_write> velocity_y_out: array<f32>;
@group(0) @binding(53) var<storage, read_write> velocity_z_out: array<f32>;

@compute @workgroup_size(64)
fn velocity_psm(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let index = invocation(group, groups, local);
    let elements = BRICK_X * BRICK_Y * BRICK_Z;
    let lane = index % LANES_OF_ELEMENT;
    let element = (index / LANES_OF_ELEMENT) % elements;
    let slot = index / (LANES_OF_ELEMENT * elements);
    if (slot >= bricks[0u]) {
        return;
    }
    let cell = cell_in(bricks[1u + slot], element, lane);
    if (any(cell >= vec3(CELLS_X, CELLS_Y, CELLS_Z))) {
        return;
    }
    let at = element * LANES_OF_ELEMENT + lane;
    let sum = decode_sum(read_psm(PLANE_SUM, slot, at));
    let beta = read_psm(PLANE_BETA, slot, at);
    if (!(sum.fraction > 0.0) || !(beta > 0.0)) {
        return;
    }
    let v = vec3(
        read_psm(PLANE_VELOCITY, slot, at),
        read_psm(PLANE_VELOCITY + 1u, slot, at),
        read_psm(PLANE_VELOCITY + 2u, slot, at),
    );
    let n = cell.x + CELLS_X * (cell.y + CELLS_Y * cell.z);
    let rho = 1.0 + density[n];
    let force = cell_force(cell) / rho;
    let before = vec3(velocity_x_out[n], velocity_y_out[n], velocity_z_out[n]) - 0.5 * force;
    let coupling = sum.fraction * read_psm(PLANE_A, slot, at) / rho;
    let u = before + 0.5 * (1.0 - sum.fraction * beta) * force + 0.5 * coupling * (v - before);
    velocity_x_out[n] = u.x;
    velocity_y_out[n] = u.y;
    velocity_z_out[n] = u.z;
}

// An element of a brick in one of its lanes; beyond the domain where it would be in the next lane.
fn cell_in(brick: u32, element: u32, lane: u32) -> vec3<u32> {
    let bricks_x = (NX + BRICK_X - 1u) / BRICK_X;
    let bricks_y = (NY + BRICK_Y - 1u) / BRICK_Y;
    let x = BRICK_X * (brick % bricks_x) + element % BRICK_X;
    let y = BRICK_Y * ((brick / bricks_x) % bricks_y) + (element / BRICK_X) % BRICK_Y;
    let z = BRICK_Z * (brick / (bricks_x * bricks_y)) + element / (BRICK_X * BRICK_Y);
    let cell = vec3(x, y + NY * (lane % LANES_Y), z + NZ * (lane / LANES_Y));
    return select(vec3(CELLS_X, CELLS_Y, CELLS_Z), cell, y < NY && z < NZ);
}
