// Chan, Golub & LeVeque 1983, Am. Stat. 37:242: the step adds the state before it to the statistics over time.
// needs velocity, grid, sum_sample, $cell_flags

fn add_sample(p: Place, cell: u32, excess: Real, u: Vector) {
    let v = still_in_solid(cell, u);
    sum_sample(p.element, Sample(select(excess, Real(0.0), solid(cell)), v.x, v.y, v.z));
}
