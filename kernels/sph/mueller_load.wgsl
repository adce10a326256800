// Geraili Mikola & Sitar 2014, section 4: the reaction of the particles inside a body.
// needs penalty, body_sums

@group(0) @binding(0) var<storage, read> particles: array<Particle>;
@group(0) @binding(5) var<storage, read> clock: Clock;
// Index of the first hull of each body, and the number of hulls as the last entry.
@group(0) @binding(9) var<storage, read> hull_starts: array<u32>;
// Half-open range of particles: a loop over all of them may exceed the iterations of an invocation.
@group(0) @binding(10) var<uniform> range: vec2<u32>;

@compute @workgroup_size(64)
fn mueller_load(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let body = group.x + group.y * groups.x;
    if (is_loaded(body) && clock.step != 0.0) {
        let motion = motions[body];
        let end = hull_starts[body + 1u];
        for (var n = range.x + local; n < range.y; n += 64u) {
            let here = particles[n];
            if (here.at.x < 0) {
                continue;
            }
            var f = vec3(0.0);
            for (var k = hull_starts[body]; k < end; k++) {
                f -= penalty(hulls[k], here.at, here.velocity, clock.elapsed);
            }
            let offset = separation(here.at, wrapped(motion.centre));
            add_force(f, offset - clock.elapsed * motion.velocity);
        }
    }
    reduce_load(body, local, clock.step);
}
