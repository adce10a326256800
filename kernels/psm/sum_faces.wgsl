// Higham 1993, SIAM J. Sci. Comput. 14:783, sums of short sums: the load on each layer of a face, summed over its jobs in
// order. An invocation adds one number of one layer.
// needs tables, workgroup_index

// Number of jobs before each layer, and of all.
@group(0) @binding(0) var<storage, read> face_first: array<u32>;
// FACE_LOAD numbers per job.
@group(0) @binding(1) var<storage, read> face_partials: array<f32>;
// FACE_LOAD numbers per layer.
@group(0) @binding(2) var<storage, read_write> face_loads: array<f32>;

@compute @workgroup_size(64)
fn sum_faces(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let number = workgroup_index(group, groups) * 64u + local;
    let face = number / FACE_LOAD;
    if (face + 1u >= arrayLength(&face_first)) {
        return;
    }
    var sum = 0.0;
    for (var job = face_first[face]; job < face_first[face + 1u]; job++) {
        sum += face_partials[job * FACE_LOAD + number % FACE_LOAD];
    }
    face_loads[number] = sum;
}
