// Noble & Torczynski 1998, eq. 4: the velocity in partially saturated cells, from a checkpoint, as velocity_psm.wgsl wrote it. It
// depends on the change by solids in the last step, which is not part of the state. Corrects the output of macroscopic.wgsl.
// needs scalar_grid

// Indices of the cells, x fastest, and their velocities, component by component.
@group(0) @binding(54) var<storage, read> restored_cells: array<u32>;
@group(0) @binding(55) var<storage, read> restored_velocity: array<f32>;
@group(0) @binding(51) var<storage, read_write> velocity_x_out: array<f32>;
@group(0) @binding(52) var<storage, read_write> velocity_y_out: array<f32>;
@group(0) @binding(53) var<storage, read_write> velocity_z_out: array<f32>;

@compute @workgroup_size(64)
fn velocity_restored(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let index = invocation(group, groups, local);
    let count = arrayLength(&restored_cells);
    if (index < count) {
        let n = restored_cells[index];
        velocity_x_out[n] = restored_velocity[index];
        velocity_y_out[n] = restored_velocity[count + index];
        velocity_z_out[n] = restored_velocity[2u * count + index];
    }
}
