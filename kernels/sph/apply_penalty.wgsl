// Geraili Mikola & Sitar 2014, eq. 22, for fluid particles that have passed between boundary particles: pressure alone
// would leave them at rest there.
// needs invocation, penalty, wall_work

@group(0) @binding(0) var<storage, read> particles: array<Particle>;
@group(0) @binding(3) var<storage, read_write> wall_work: array<WallWork>;
// Velocity at the end of the step, and the longest next step.
@group(0) @binding(4) var<storage, read_write> new_velocities: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> clock: Clock;

@compute @workgroup_size(64)
fn apply_penalty(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= arrayLength(&particles) || clock.step == 0.0 || wall_work[n].near_boundary == 0u) {
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
    new_velocities[n] += vec4(clock.step * push, 0.0);
    // The velocity changes linearly in a step.
    wall_work[n].penalty_work = 0.5 * clock.step * dot(push, here.velocity + new_velocities[n].xyz);
}
