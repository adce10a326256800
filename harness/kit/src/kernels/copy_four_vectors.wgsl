// McCalpin 1995, STREAM, the copy test: every value is read once and written once, 64 bytes per invocation,
// in pieces of 16 bytes that are contiguous over neighbouring invocations.

@group(0) @binding(0) var<storage, read> original: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> duplicate: array<vec4<f32>>;

@compute @workgroup_size(64)
fn copy_four_vectors(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let first = (group.x + group.y * groups.x) * 256u + local;
    if (first + 192u < arrayLength(&original)) {
        for (var k = 0u; k < 4u; k++) { // unroll
            duplicate[first + 64u * k] = original[first + 64u * k];
        }
    }
}
