// Chan, Golub & LeVeque 1983, Am. Stat. 37:242: the step adds the state before it to the statistics over time.
// needs velocity, grid, sum_sample, $cell_flags, $psm, $force

// After collide_with_solid: `change` has the change by the solid alone.
fn add_sample(
    p: Place,
    cell: u32,
    excess: Real,
    rho: Real,
    u: Vector,
    weights: SolidWeights,
    change: ptr<function, array<Real, 27>>,
) {
    let zero = Real(0.0);
    let by_half_force = fluid_velocity(p, rho, Vector(zero, zero, zero));
    let v = still_in_solid(cell, velocity_at_middle(weights, rho, u, by_half_force, change));
    sum_sample(p.element, Sample(select(excess, zero, solid(cell)), v.x, v.y, v.z));
}
