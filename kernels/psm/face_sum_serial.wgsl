// One invocation per job: no barriers, which cost a CPU more than the sum.
// needs face_cell_load

fn sum_job(index: u32, local: u32) {
    let number = index * 64u + local;
    if (number >= arrayLength(&jobs)) {
        return;
    }
    add_layer(jobs[number], 0u, 1u);
    for (var k = 0u; k < 18u; k++) { // unroll
        face_partials[number * FACE_LOAD + k] = sums[k];
    }
}
