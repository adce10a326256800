// Blocks without a wall model.
// needs velocity, grid, $lanes

fn apply_wall_stress(p: Place, slot: u32, local: u32, rho: Real, v: Vector, h: ptr<function, array<Real, 27>>, s: ptr<function, array<Real, 27>>) -> Real {
    return Real(0.0);
}

fn with_law(weight: Real, share_of_law: Real) -> Real {
    return weight;
}

fn sliding_velocity(p: Place, slot: u32, local: u32, rho: Real, v: Vector, h: ptr<function, array<Real, 27>>) -> Vector {
    return v;
}
