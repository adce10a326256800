// Guo, Zheng & Shi 2002: the part of the body force that the pressure balances in fluid at rest: that along axes along which the
// domain does not repeat.
// needs velocity, grid, $body_force

// 1 along these axes, else 0.
override BALANCED_X: f32;
override BALANCED_Y: f32;
override BALANCED_Z: f32;

fn balanced_force(p: Place) -> Vector {
    let force = body_force(p);
    return Vector(BALANCED_X * force.x, BALANCED_Y * force.y, BALANCED_Z * force.z);
}
