// One invocation per segment: no barriers, which cost a CPU more than the sum.
// needs cell_load

fn sum_segment(index: u32, local: u32) {
    let number = index * 64u + local;
    let segment = segment_at(number);
    if (segment == NOTHING) {
        return;
    }
    add_segment(segment, 0u, 1u);
    for (var k = 0u; k < 20u; k++) { // unroll
        partials[number * WRENCH + k] = wrench[k];
    }
}
