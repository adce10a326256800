// No body force.
// needs velocity, grid

fn balanced_force(p: Place) -> Vector {
    return Vector(Real(0.0), Real(0.0), Real(0.0));
}
