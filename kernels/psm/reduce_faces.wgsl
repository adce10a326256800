// Batchelor 1967, eq. 3.3.11 at a wall: the sum of the tractions in a layer of cells along a face, for each job.
// needs workgroup_index, $face_sum

@compute @workgroup_size(64)
fn reduce_faces(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    sum_job(workgroup_index(group, groups), local);
}
