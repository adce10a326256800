// Gardner & Sitar 2018, eqs. 11-12, for particles: the load on each body from the forces on its boundary particles.
// needs bodies, clock, body_sums

@group(0) @binding(0) var<storage, read> reference_positions: array<ReferencePosition>;
@group(0) @binding(1) var<storage, read> motions: array<BodyMotion>;
@group(0) @binding(2) var<storage, read> forces: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> clock: Clock;

@compute @workgroup_size(64)
fn body_load(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let body = group.x + group.y * groups.x;
    if (is_loaded(body) && clock.step != 0.0) {
        let motion = motions[body];
        let end = motion.first + motion.count;
        for (var n = motion.first + local; n < end; n += 64u) {
            let x = reference_positions[n].position;
            let rotated = clock.elapsed * (velocity_at(motion, x) - motion.velocity);
            add_force(forces[n].xyz, lever(motion, x) + rotated);
        }
    }
    reduce_load(body, local, clock.step);
}
