// Guo, Zheng & Shi 2002: a force per volume of each cell, lattice units, one component after the other.
// needs velocity, grid, $reals

@group(0) @binding(33) var<storage, read> force_field: array<Reals>;

fn body_force(p: Place) -> Vector {
    let elements = NX * NY * SLICES;
    return Vector(
        get_reals(force_field[p.element]),
        get_reals(force_field[elements + p.element]),
        get_reals(force_field[2u * elements + p.element]),
    );
}
