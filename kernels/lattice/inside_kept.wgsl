// Noble & Torczynski 1998, eq. 4: the velocity in partially saturated cells as inside_solids.wgsl left it in the run that wrote a
// checkpoint; what solids did in its last step is no part of the state. Corrects what macroscopic.wgsl has written.
// needs scalar_grid

// Places of the cells, x fastest, and their velocities, component by component.
@group(0) @binding(54) var<storage, read> kept_cells: array<u32>;
@group(0) @binding(55) var<storage, read> kept_velocity: array<f32>;
@group(0) @binding(51) var<storage, read_write> velocity_x_out: array<f32>;
@group(0) @binding(52) var<storage, read_write> velocity_y_out: array<f32>;
@group(0) @binding(53) var<storage, read_write> velocity_z_out: array<f32>;

@compute @workgroup_size(64)
fn inside_kept(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let turn = invocation(group, groups, local);
    let count = arrayLength(&kept_cells);
    if (turn < count) {
        let n = kept_cells[turn];
        velocity_x_out[n] = kept_velocity[turn];
        velocity_y_out[n] = kept_velocity[count + turn];
        velocity_z_out[n] = kept_velocity[2u * count + turn];
    }
}
