// Ladd 1994, J. Fluid Mech. 271:285, half-way bounce-back, and specular reflection: a population that has
// arrived behind a wall returns to a fluid cell in the reflected direction.
// needs link

@group(0) @binding(40) var<storage, read> links: array<Link>;

@compute @workgroup_size(64)
fn reflect(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= arrayLength(&links)) {
        return;
    }
    let link = links[n];
    write_returned(link, read_arrived(link));
}
