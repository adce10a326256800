// No block is in the fluid.
// needs velocity, grid, $lanes

struct Saturation {
    unused: u32,
}

fn saturation_of(slot: u32, local: u32) -> Saturation {
    return Saturation(0u);
}

fn mean_velocity(saturation: Saturation, u: Vector) -> Vector {
    return u;
}

fn outside_solids(saturation: Saturation, nu_t: Real) -> Real {
    return nu_t;
}

fn saturate(
    p: Place,
    slot: u32,
    local: u32,
    cell: u32,
    saturation: Saturation,
    excess: Real,
    rho: Real,
    u: Vector,
    h: ptr<function, array<Real, 27>>,
    change: ptr<function, array<Real, 27>>,
) {
}
