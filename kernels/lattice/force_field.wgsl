// Guo, Zheng & Shi 2002: a force per volume of each cell, lattice units.
// needs velocity, grid, forces, $reals

fn body_force(p: Place) -> Vector {
    return Vector(
        unpack_reals(read_force(0u, p.element)),
        unpack_reals(read_force(1u, p.element)),
        unpack_reals(read_force(2u, p.element)),
    );
}
