// Time integral of force and moment on each body over an exchange. One workgroup sums one body.

// Twelve components per body: force, and the sum of f_i r_j at 3 + 3 i + j.
@group(0) @binding(4) var<storage, read_write> loads: array<f32>;

const LOAD_LEN = 12u;

var<workgroup> sums: array<array<f32, 12>, 64>;

// Sums of an invocation.
var<private> force: vec3<f32>;
var<private> moment: array<vec3<f32>, 3>;

// A force at the offset r from the centroid.
fn add_force(f: vec3<f32>, r: vec3<f32>) {
    force += f;
    moment[0] += f.x * r;
    moment[1] += f.y * r;
    moment[2] += f.z * r;
}

// Replaces the symmetric part of the moment.
fn replace_symmetric_part(part: mat3x3<f32>) {
    let all = mat3x3(moment[0], moment[1], moment[2]);
    let torque = 0.5 * (all - transpose(all));
    for (var i = 0u; i < 3u; i++) {
        moment[i] = torque[i] + part[i];
    }
}

fn is_loaded(body: u32) -> bool {
    return body < arrayLength(&loads) / LOAD_LEN;
}

// Adds the sums of all invocations to the load of the body. All invocations must call it.
fn reduce_load(body: u32, local: u32, step: f32) {
    sums[local] = array(
        force.x, force.y, force.z,
        moment[0].x, moment[0].y, moment[0].z,
        moment[1].x, moment[1].y, moment[1].z,
        moment[2].x, moment[2].y, moment[2].z,
    );
    workgroupBarrier();
    if (is_loaded(body) && local < LOAD_LEN) {
        var sum = 0.0;
        for (var n = 0u; n < 64u; n++) {
            sum += sums[n][local];
        }
        loads[body * LOAD_LEN + local] += step * sum;
    }
}
