// Merrill & Grimshaw 2009, Parallel scan for stream architectures, the way up: the longest step that all particles of
// each run of 64 allow, and the highest speed.
// needs invocation

// Velocities, or speeds as first numbers, and steps.
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
    var limit = limits[n * RUN].w;
    var square = 0.0;
    for (var k = n * RUN; k < end; k++) {
        let here = limits[k];
        limit = min(limit, here.w);
        square = max(square, dot(here.xyz, here.xyz));
    }
    run_limits[n] = vec4(sqrt(square), 0.0, 0.0, limit);
}
