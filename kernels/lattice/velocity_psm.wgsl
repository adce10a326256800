// Noble & Torczynski 1998, eq. 4: in a partially saturated cell the momentum of a step is the momentum at mid-step, after half
// of the body force on the fluid, (1 - B) F, and half of the change by the solid. In a steady flow the momentum of a plane of
// cells then equals the flux across it, wherever solids are: exactly with the operator of Holdych, plus a part of the body force
// with the others. Corrects the output of macroscopic.wgsl.
// needs psm_bricks, psm_planes, psm_storage, $cell_force

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
    let here = psm_invocation(invocation(group, groups, local));
    if (here.slot >= bricks[0u]) {
        return;
    }
    let cell = cell_at(here);
    if (any(cell >= vec3(CELLS_X, CELLS_Y, CELLS_Z))) {
        return;
    }
    let place = here.element * LANES_OF_ELEMENT + here.lane;
    let sum = decode_sum(read_psm(PLANE_SUM, here.slot, place));
    let beta = read_psm(PLANE_BETA, here.slot, place);
    if (!(sum.fraction > 0.0) || !(beta > 0.0)) {
        return;
    }
    let v = vec3(
        read_psm(PLANE_VELOCITY, here.slot, place),
        read_psm(PLANE_VELOCITY + 1u, here.slot, place),
        read_psm(PLANE_VELOCITY + 2u, here.slot, place),
    );
    let n = cell.x + CELLS_X * (cell.y + CELLS_Y * cell.z);
    let rho = 1.0 + density[n];
    let force = cell_force(cell) / rho;
    let before = vec3(velocity_x_out[n], velocity_y_out[n], velocity_z_out[n]) - 0.5 * force;
    let coupling = sum.fraction * read_psm(PLANE_A, here.slot, place) / rho;
    let u = before + 0.5 * (1.0 - sum.fraction * beta) * force + 0.5 * coupling * (v - before);
    velocity_x_out[n] = u.x;
    velocity_y_out[n] = u.y;
    velocity_z_out[n] = u.z;
}
