// Geraili Mikola & Sitar 2014, eq. 22, for what has come into a body in spite of its shell: pressures alone leave water
// at rest between the particles of a shell once it is there.
// needs invocation, penalty, shelter

@group(0) @binding(0) var<storage, read> particles: array<Particle>;
@group(0) @binding(3) var<storage, read_write> shelter: array<Shelter>;
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
    if (n >= arrayLength(&particles) || clock.step == 0.0 || shelter[n].near == 0u) {
        return;
    }
    let here = particles[n];
    var push = vec3(0.0);
    for (var k = 0u; k < arrayLength(&hulls); k++) {
        push += penalty(hulls[k], here.at, here.velocity, clock.elapsed);
    }
    if (all(push == vec3(0.0))) {
        return;
    }
    fresh[n] += vec4(clock.step * push, 0.0);
    // Velocity changes evenly in a step.
    shelter[n].pushed = 0.5 * clock.step * dot(push, here.velocity + fresh[n].xyz);
}
