// Ladd 1994, J. Fluid Mech. 271:285, half-way bounce-back, and specular reflection: a population that has
// arrived behind a wall returns to a fluid cell in the reflected direction.
// needs scalar_grid, scalars

// Scalar read, scalar written, and the directions of both words as they are in an even step.
struct Link {
    scalar_from: u32,
    scalar_to: u32,
    directions: u32,
}

@group(0) @binding(40) var<storage, read> links: array<Link>;

fn in_step(direction: u32) -> u32 {
    return ((direction - 1u) ^ cell_pass.odd) + 1u;
}

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
    let value = read_scalar(in_step(link.directions & 31u), link.scalar_from);
    write_scalar(in_step(link.directions >> 5u), link.scalar_to, value);
}
