// Noble & Torczynski 1998, eq. 4: the velocity in partially saturated cells as velocity_psm.wgsl wrote it in the run that wrote a
// checkpoint; what solids did in its last step is no part of the state. Corrects what macroscopic.wgsl has written.
// needs scalar_grid

// Places of the cells, x fastest, and their velocities, component by component.
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
