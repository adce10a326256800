// Vectors whose components are Real: a scalar, or one value per lane.
// needs $lanes

struct Vector {
    x: Real,
    y: Real,
    z: Real,
}

fn vec3_of(x: Real, y: Real, z: Real) -> Vector {
    return Vector(x, y, z);
}
