// Verlet 1967, Phys. Rev. 159:98: postpones a step with a truncated list until the host has enlarged the lists.
// needs clock

@group(0) @binding(0) var<storage, read_write> clock: Clock;

@compute @workgroup_size(1)
fn check_capacity() {
    if (clock.overflow + clock.boundary_overflow > 0u && clock.step != 0.0) {
        clock.pending_step = clock.step;
        clock.step = 0.0;
    }
}
