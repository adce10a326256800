// No body force: u = j / rho.
// needs velocity, grid

fn fluid_velocity(p: Place, rho: Real, j: Vector) -> Vector {
    let inverse = 1.0 / rho;
    return Vector(j.x * inverse, j.y * inverse, j.z * inverse);
}

fn take_half_source(p: Place, u: Vector, d: ptr<function, array<Real, 27>>) {
}

fn add_source(p: Place, u: Vector, h: ptr<function, array<Real, 27>>) {
}
