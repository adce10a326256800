// McCalpin 1995, STREAM, the copy test: every value is read once and written once, 16 bytes per invocation.

@group(0) @binding(0) var<storage, read> original: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> duplicate: array<vec4<f32>>;

@compute @workgroup_size(64)
fn copy_vector(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = (group.x + group.y * groups.x) * 64u + local;
    if (n < arrayLength(&original)) {
        duplicate[n] = original[n];
    }
}
