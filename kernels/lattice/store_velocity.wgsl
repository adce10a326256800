// The velocity of this step, for the gradients of the next one.
// needs velocity, grid, $cell_flags, $reals

@group(0) @binding(31) var<storage, read_write> velocity_after: array<Reals>;

fn store_velocity(p: Place, cell: u32, u: Vector) {
    let stored = still_in_solid(cell, u);
    let elements = NX * NY * SLICES;
    velocity_after[p.element] = put_reals(stored.x);
    velocity_after[elements + p.element] = put_reals(stored.y);
    velocity_after[2u * elements + p.element] = put_reals(stored.z);
}
