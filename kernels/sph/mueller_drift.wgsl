// Geraili Mikola & Sitar 2014, eq. 21: positions advance with the new velocities.
// needs invocation, advect

@group(0) @binding(0) var<storage, read> particles: array<Particle>;
@group(0) @binding(4) var<storage, read> new_velocities: array<vec4<f32>>;

@compute @workgroup_size(64)
fn mueller_drift(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= arrayLength(&particles)) {
        return;
    }
    var here = particles[n];
    if (here.at.x < 0 || clock.step == 0.0) {
        moved[n] = here;
        return;
    }
    here.velocity = new_velocities[n].xyz;
    advect(n, here);
}
