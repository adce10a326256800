// Guo, Zheng & Shi 2002: a force per volume of each cell, lattice units, one component after the other.
// needs velocity, grid

@group(0) @binding(33) var<storage, read> force_field: array<Real>;

fn body_force(p: Place) -> Vector {
    let elements = NX * NY * SLICES;
    return Vector(
        force_field[p.element],
        force_field[elements + p.element],
        force_field[2u * elements + p.element],
    );
}
