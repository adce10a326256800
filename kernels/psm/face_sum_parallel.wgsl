// One workgroup per job: 64 invocations share its cells, and the first FACE_LOAD of them add up one number each.
// needs face_cell_load

// The sums of an invocation are contiguous, so that the invocations that add them read from different banks.
var<workgroup> sums_of_all: array<f32, 64 * FACE_LOAD>;

fn sum_job(index: u32, local: u32) {
    let here = index < arrayLength(&jobs);
    if (here) {
        add_layer(jobs[index], local, 64u);
    }
    for (var k = 0u; k < 18u; k++) { // unroll
        sums_of_all[local * FACE_LOAD + k] = sums[k];
    }
    workgroupBarrier();
    if (!here || local >= FACE_LOAD) {
        return;
    }
    var sum = 0.0;
    for (var n = 0u; n < 64u; n++) {
        sum += sums_of_all[n * FACE_LOAD + local];
    }
    face_partials[index * FACE_LOAD + local] = sum;
}
