// Hunt, Wray & Moin 1988 and others: a scalar from the velocity gradient of each domain cell, lattice units.
// needs scalar_grid, cell_gradient, $quantity

@group(0) @binding(54) var<storage, read_write> derived: array<f32>;

@compute @workgroup_size(64)
fn derive(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= CELLS_X * CELLS_Y * CELLS_Z) {
        return;
    }
    let cell = domain_cell(n);
    let cell_flags = flags_of(cell);
    if ((cell_flags & 128u) != 0u) {
        derived[n] = 0.0;
        return;
    }
    derived[n] = quantity(cell_gradient(cell, cell_flags));
}
