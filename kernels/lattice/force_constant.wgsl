// Guo, Zheng & Shi 2002: one force per volume everywhere, lattice units.
// needs velocity, grid

override FORCE_X: f32;
override FORCE_Y: f32;
override FORCE_Z: f32;

fn body_force(p: Place) -> Vector {
    return Vector(Real(FORCE_X), Real(FORCE_Y), Real(FORCE_Z));
}
