// The step adds no sample to the statistics over time.
// needs velocity, grid, $psm

fn add_sample(
    p: Place,
    cell: u32,
    excess: Real,
    rho: Real,
    u: Vector,
    weights: SolidWeights,
    change: ptr<function, array<Real, 27>>,
) {
}
