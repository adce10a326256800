// Guo, Zheng & Shi 2002: a force per volume of each cell, lattice units, one component after the other.
// needs scalar_grid

@group(0) @binding(33) var<storage, read> force_field: array<f32>;

fn cell_force(cell: vec3<u32>) -> vec3<f32> {
    let scalars = NX * NY * SLICES * LANES_OF_ELEMENT;
    let n = scalar_of(cell);
    return vec3(force_field[n], force_field[scalars + n], force_field[2u * scalars + n]);
}
