// The step adds no sample to the statistics over time.
// needs velocity, grid

fn add_sample(p: Place, cell: u32, excess: Real, u: Vector) {
}
