// Merrill & Grimshaw 2009, Parallel scan for stream architectures, first upsweep: for each group of 64 particles, the
// largest speed, the boundary and penalty work, and the longest step that all allow.
// needs invocation, wall_work

// Velocity at the end of the step, and the longest next step.
@group(0) @binding(0) var<storage, read> new_velocities: array<vec4<f32>>;
// One for each group.
@group(0) @binding(1) var<storage, read_write> group_limits: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> wall_work: array<WallWork>;

const GROUP_SIZE = 64u;

@compute @workgroup_size(64)
fn reduce_particle_limits(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= arrayLength(&group_limits)) {
        return;
    }
    let end = min((n + 1u) * GROUP_SIZE, arrayLength(&new_velocities));
    var limit = new_velocities[n * GROUP_SIZE].w;
    var square = 0.0;
    var works = vec2(0.0);
    for (var k = n * GROUP_SIZE; k < end; k += 8u) {
        // Independent loads.
        var next: array<vec4<f32>, 8>;
        var next_works: array<vec2<f32>, 8>;
        for (var i = 0u; i < 8u; i++) { // unroll
            let at = min(k + i, end - 1u);
            next[i] = new_velocities[at];
            next_works[i] = select(vec2(0.0), vec2(wall_work[at].boundary_work, wall_work[at].penalty_work), k + i < end);
        }
        for (var i = 0u; i < 8u; i++) { // unroll
            limit = min(limit, next[i].w);
            square = max(square, dot(next[i].xyz, next[i].xyz));
            works += next_works[i];
        }
    }
    group_limits[n] = vec4(sqrt(square), works, limit);
}
