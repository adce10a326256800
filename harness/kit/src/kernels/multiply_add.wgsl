// Williams, Waterman & Patterson 2009, Commun. ACM 52:65, Roofline: the ceiling of arithmetic. Independent products and
// sums of eight vectors per invocation, and one store.

override TURNS: u32;

@group(0) @binding(0) var<storage, read> factors: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> sums: array<vec4<f32>>;

@compute @workgroup_size(64)
fn multiply_add(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = (group.x + group.y * groups.x) * 64u + local;
    let a = factors[0];
    let b = factors[1];
    var x: array<vec4<f32>, 8>;
    for (var k = 0u; k < 8u; k++) { // unroll
        x[k] = vec4<f32>(f32(n + k));
    }
    for (var index = 0u; index < TURNS; index++) {
        for (var k = 0u; k < 32u; k++) { // unroll
            x[k % 8u] = x[k % 8u] * a + b;
        }
    }
    if (n < arrayLength(&sums)) {
        sums[n] = x[0] + x[1] + x[2] + x[3] + x[4] + x[5] + x[6] + x[7];
    }
}
