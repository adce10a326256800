// Verlet 1967, Phys. Rev. 159:98: no step with a list that is cut off; the host makes room and goes on with it.
// needs clock

@group(0) @binding(0) var<storage, read_write> clock: Clock;

@compute @workgroup_size(1)
fn admit() {
    if (clock.crowd + clock.shell_crowd > 0u && clock.step != 0.0) {
        clock.held = clock.step;
        clock.step = 0.0;
    }
}
