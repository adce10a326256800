// Geraili Mikola & Sitar 2014, eq. 22, for what has come into a body in spite of its shell: pressures alone leave water
// at rest between the particles of a shell once it is there.
// needs invocation, penalty

@group(0) @binding(0) var<storage, read> particles: array<Particle>;
// 1 for each particle that has one of a shell near it.
@group(0) @binding(3) var<storage, read> shelter: array<u32>;
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
    if (n >= arrayLength(&particles) || clock.step == 0.0 || shelter[n] == 0u) {
        return;
    }
    let here = particles[n];
    var push = vec3(0.0);
    for (var k = 0u; k < arrayLength(&hulls); k++) {
        push += penalty(hulls[k], here.at, here.velocity, clock.elapsed);
    }
    fresh[n] += vec4(clock.step * push, 0.0);
}
