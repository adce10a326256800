// Merrill & Grimshaw 2009, Parallel scan for stream architectures, reduce-then-scan, upsweep: the sum of each
// run of 64 values. One invocation adds a whole run: no barriers, and short loops.
// needs invocation, saturate

@group(0) @binding(0) var<storage, read> values: array<u32>;
// One per run.
@group(0) @binding(1) var<storage, read_write> run_sums: array<u32>;

const RUN = 64u;

@compute @workgroup_size(64)
fn scan_sum(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let run = invocation(group, groups, local);
    if (run >= arrayLength(&run_sums)) {
        return;
    }
    let end = min((run + 1u) * RUN, arrayLength(&values));
    var sum = 0u;
    for (var n = run * RUN; n < end; n += 8u) {
        // Eight independent loads.
        var next: array<u32, 8>;
        for (var k = 0u; k < 8u; k++) { // unroll
            next[k] = select(0u, values[n + k], n + k < end);
        }
        for (var k = 0u; k < 8u; k++) { // unroll
            sum = saturating_add(sum, next[k]);
        }
    }
    run_sums[run] = sum;
}
