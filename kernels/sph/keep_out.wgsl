// Geraili Mikola & Sitar 2014, eq. 22, for what has come into a body in spite of its shell: pressures alone leave water
// at rest between the particles of a shell once it is there.
// needs invocation, penalty

@group(0) @binding(0) var<storage, read> particles: array<Particle>;
// Sum of slope times distance over the shells around each particle, which points out of them, and 1 if one of them is
// near; the last becomes what the former is to be multiplied with for the push.
@group(0) @binding(3) var<storage, read_write> shelter: array<vec4<f32>>;
// Velocity, and the longest step.
@group(0) @binding(4) var<storage, read_write> fresh: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> clock: Clock;

@compute @workgroup_size(64)
fn keep_out(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= arrayLength(&particles) || clock.step == 0.0 || shelter[n].w == 0.0) {
        return;
    }
    let here = particles[n];
    let outward = shelter[n].xyz;
    var push = vec3(0.0);
    for (var k = 0u; k < arrayLength(&hulls); k++) {
        push += penalty(hulls[k], here.at, here.velocity, clock.elapsed);
    }
    // Along what the shells are pushed back by, which is where they end.
    let share = max(dot(push, outward), 0.0) / max(dot(outward, outward), 1e-12);
    shelter[n].w = share;
    fresh[n] += vec4(clock.step * share * outward, 0.0);
}
