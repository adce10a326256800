// Gardner & Sitar 2018, eqs. 11-12, of particles: force and moment on each body, a workgroup a body, added up over
// the steps of an exchange.
// needs bodies, clock

@group(0) @binding(0) var<storage, read> homes: array<Home>;
@group(0) @binding(1) var<storage, read> motions: array<Motion>;
@group(0) @binding(2) var<storage, read> forces: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> clock: Clock;
// Twelve numbers a body: force times time, and the sum of f_i r_j at 3 + 3 i + j.
@group(0) @binding(4) var<storage, read_write> loads: array<f32>;

const NUMBERS = 12u;

var<workgroup> sums: array<array<f32, 12>, 64>;

@compute @workgroup_size(64)
fn body_load(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let body = group.x + group.y * groups.x;
    let known = body < arrayLength(&loads) / NUMBERS;
    var force = vec3(0.0);
    var moment_x = vec3(0.0);
    var moment_y = vec3(0.0);
    var moment_z = vec3(0.0);
    if (known && clock.step != 0.0) {
        let motion = motions[body];
        let end = motion.first + motion.count;
        for (var n = motion.first + local; n < end; n += 64u) {
            let x = homes[n].place;
            let r = lever(motion, x) + clock.elapsed * (velocity_at(motion, x) - motion.velocity);
            let f = forces[n].xyz;
            force += f;
            moment_x += f.x * r;
            moment_y += f.y * r;
            moment_z += f.z * r;
        }
    }
    sums[local] = array(
        force.x, force.y, force.z,
        moment_x.x, moment_x.y, moment_x.z,
        moment_y.x, moment_y.y, moment_y.z,
        moment_z.x, moment_z.y, moment_z.z,
    );
    workgroupBarrier();
    if (known && local < NUMBERS) {
        var sum = 0.0;
        for (var n = 0u; n < 64u; n++) {
            sum += sums[n][local];
        }
        loads[body * NUMBERS + local] += clock.step * sum;
    }
}
