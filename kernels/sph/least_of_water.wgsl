// Merrill & Grimshaw 2009, Parallel scan for stream architectures, the first step up: of each run of 64 particles the
// highest speed, the works of shells and pushes, and the longest step that all allow.
// needs invocation, shelter

// Velocity, and the longest step.
@group(0) @binding(0) var<storage, read> fresh: array<vec4<f32>>;
// One a run.
@group(0) @binding(1) var<storage, read_write> run_limits: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> shelter: array<Shelter>;

const RUN = 64u;

@compute @workgroup_size(64)
fn least_of_water(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= arrayLength(&run_limits)) {
        return;
    }
    let end = min((n + 1u) * RUN, arrayLength(&fresh));
    var limit = fresh[n * RUN].w;
    var square = 0.0;
    var works = vec2(0.0);
    for (var k = n * RUN; k < end; k++) {
        let here = fresh[k];
        limit = min(limit, here.w);
        square = max(square, dot(here.xyz, here.xyz));
        works += vec2(shelter[k].pressed, shelter[k].pushed);
    }
    run_limits[n] = vec4(sqrt(square), works, limit);
}
