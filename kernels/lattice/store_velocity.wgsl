// The velocity of this step, for the gradients of the next one.
// needs velocity, velocities, grid, $cell_flags, $reals, $wale_interval

fn store_velocity(p: Place, cell: u32, u: Vector) {
    if (!keeps_velocity()) {
        return;
    }
    let stored = still_in_solid(cell, u);
    write_after(0u, p.element, pack_reals(stored.x));
    write_after(1u, p.element, pack_reals(stored.y));
    write_after(2u, p.element, pack_reals(stored.z));
}
