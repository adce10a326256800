// Ladd 1994, J. Fluid Mech. 271:285, half-way bounce-back, and specular reflection: a population that has
// arrived behind a wall returns to a fluid cell in the reflected direction.
// needs link

// The first link of each row.
@group(0) @binding(40) var<storage, read> links: array<Link>;

// Links of a row, and how many of them an invocation processes.
override LINKS_OF_ROW: u32;
override LINKS_OF_INVOCATION: u32;

@compute @workgroup_size(64)
fn reflect(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local) * LINKS_OF_INVOCATION;
    if (n / LINKS_OF_ROW >= arrayLength(&links)) {
        return;
    }
    let first = links[n / LINKS_OF_ROW];
    for (var k = 0u; k < LINKS_OF_INVOCATION; k++) {
        let link = later_in_row(first, n % LINKS_OF_ROW + k);
        write_returned(link, read_arrived(link));
    }
}
