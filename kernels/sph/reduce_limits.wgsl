// Merrill & Grimshaw 2009, Parallel scan for stream architectures, upsweep: for each group of 64, the largest speed,
// the boundary and penalty work, and the longest step that all allow.
// needs invocation

@group(0) @binding(0) var<storage, read> limits: array<vec4<f32>>;
// One for each group.
@group(0) @binding(1) var<storage, read_write> group_limits: array<vec4<f32>>;

const GROUP_SIZE = 64u;

@compute @workgroup_size(64)
fn reduce_limits(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= arrayLength(&group_limits)) {
        return;
    }
    let end = min((n + 1u) * GROUP_SIZE, arrayLength(&limits));
    var combined = limits[n * GROUP_SIZE];
    for (var k = n * GROUP_SIZE + 1u; k < end; k += 8u) {
        // Eight independent loads.
        var next: array<vec4<f32>, 8>;
        for (var i = 0u; i < 8u; i++) { // unroll
            next[i] = select(vec4(0.0, 0.0, 0.0, combined.w), limits[k + i], k + i < end);
        }
        for (var i = 0u; i < 8u; i++) { // unroll
            combined = vec4(max(combined.x, next[i].x), combined.yz + next[i].yz, min(combined.w, next[i].w));
        }
    }
    group_limits[n] = combined;
}
