// Sum of the wrenches of a workgroup of 64 in a fixed order.
// needs wrench

// The values of an invocation are contiguous, so that the invocations that add them read from different banks.
var<workgroup> wrenches_of_all: array<f32, 64 * WRENCH>;

// Component `local` of the sum, for the first WRENCH invocations.
fn sum_of_all(local: u32) -> f32 {
    for (var k = 0u; k < 20u; k++) { // unroll
        wrenches_of_all[local * WRENCH + k] = wrench[k];
    }
    workgroupBarrier();
    var sum = 0.0;
    if (local < WRENCH) {
        for (var n = 0u; n < 64u; n++) {
            sum += wrenches_of_all[n * WRENCH + local];
        }
    }
    return sum;
}
