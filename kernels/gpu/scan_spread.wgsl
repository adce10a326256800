// Merrill & Grimshaw 2009, Parallel scan for stream architectures, reduce-then-scan, downsweep: each value
// becomes the sum of all preceding values, from the sums before its run.
// needs invocation, saturate

@group(0) @binding(0) var<storage, read_write> scanned: array<u32>;
// The sum of all values before each run.
@group(0) @binding(1) var<storage, read> run_starts: array<u32>;

const RUN = 64u;

@compute @workgroup_size(64)
fn scan_spread(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let run = invocation(group, groups, local);
    let length = arrayLength(&scanned);
    if (run >= (length + RUN - 1u) / RUN) {
        return;
    }
    let end = min((run + 1u) * RUN, length);
    var sum = run_starts[run];
    for (var n = run * RUN; n < end; n += 8u) {
        // Eight independent loads.
        var next: array<u32, 8>;
        for (var k = 0u; k < 8u; k++) { // unroll
            next[k] = scanned[min(n + k, end - 1u)];
        }
        for (var k = 0u; k < 8u; k++) { // unroll
            if (n + k < end) {
                scanned[n + k] = sum;
            }
            sum = saturating_add(sum, next[k]);
        }
    }
}
