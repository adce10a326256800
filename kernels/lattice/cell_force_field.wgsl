// Guo, Zheng & Shi 2002: a force per volume of each cell, lattice units.
// needs scalar_grid, forces

fn cell_force(cell: vec3<u32>) -> vec3<f32> {
    let n = scalar_of(cell);
    return vec3(read_force(0u, n), read_force(1u, n), read_force(2u, n));
}
