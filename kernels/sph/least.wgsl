// Merrill & Grimshaw 2009, Parallel scan for stream architectures, the way up: of each run of 64 the highest speed, the
// works of shells and pushes, and the longest step that all allow.
// needs invocation

@group(0) @binding(0) var<storage, read> limits: array<vec4<f32>>;
// One a run.
@group(0) @binding(1) var<storage, read_write> run_limits: array<vec4<f32>>;

const RUN = 64u;

@compute @workgroup_size(64)
fn least(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= arrayLength(&run_limits)) {
        return;
    }
    let end = min((n + 1u) * RUN, arrayLength(&limits));
    var least = limits[n * RUN];
    for (var k = n * RUN + 1u; k < end; k++) {
        let here = limits[k];
        least = vec4(max(least.x, here.x), least.yz + here.yz, min(least.w, here.w));
    }
    run_limits[n] = least;
}
