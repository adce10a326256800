// Chan, Golub & LeVeque 1983, Am. Stat. 37:242, eqs. 2.1: means and covariances over time of density and velocity, from
// blocks of samples that are shifted by the mean so far. For single cells: the first sample, the end of a block, output, and
// samples of the fields of an observer.
// needs scalar_grid, sum_sample, $sample

@group(0) @binding(54) var<storage, read_write> derived: array<f32>;

struct StatisticsPass {
    // The plane that is written to `derived`.
    plane: u32,
    // Samples of the open block.
    samples: f32,
    // Their share of all samples.
    weight: f32,
    pad: u32,
}

@group(0) @binding(57) var<uniform> statistics_pass: StatisticsPass;

// The two factors of covariance k.
fn factors(k: u32) -> vec2<u32> {
    return select(vec2(k), vec2(k - 3u, k % 3u + 1u), k > 3u);
}

// A mean or covariance including the samples of the open block.
fn merged(plane: u32, n: u32) -> f32 {
    let before = read_statistic(plane, n);
    let samples = statistics_pass.samples;
    let weight = statistics_pass.weight;
    if (samples == 0.0) {
        return before;
    }
    if (plane < 4u) {
        return before + weight * read_statistic(SUMS + plane, n) / samples;
    }
    let pair = factors(plane - 4u);
    let shift = read_statistic(SUMS + pair.x, n) / samples * (read_statistic(SUMS + pair.y, n) / samples);
    let own = read_statistic(PRODUCTS + plane - 4u, n) / samples - shift;
    return before + weight * (own + (1.0 - weight) * shift - before);
}

// A cell by the place of its sums, the order of the scalars; the padding is outside.
struct CellOfSums {
    scalar: u32,
    cell: vec3<u32>,
    outside: bool,
}

fn cell_of_sums(n: u32) -> CellOfSums {
    let cell = cell_of_scalar(n);
    return CellOfSums(n, cell, n >= NX * NY * NZ * LANES_OF_ELEMENT || any(cell >= vec3(CELLS_X, CELLS_Y, CELLS_Z)));
}

// The first sample is the mean so far.
@compute @workgroup_size(64)
fn begin_statistics(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let at = cell_of_sums(invocation(group, groups, local));
    if (at.outside) {
        return;
    }
    let x = sample(at.cell);
    for (var k = 0u; k < 4u; k++) { // unroll
        set_statistic(k, at.scalar, x[k]);
    }
    for (var k = 4u; k < 22u; k++) { // unroll
        set_statistic(k, at.scalar, 0.0);
    }
}

@compute @workgroup_size(64)
fn add_observed(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let at = cell_of_sums(invocation(group, groups, local));
    if (at.outside) {
        return;
    }
    let x = sample(at.cell);
    sum_sample(at.scalar, Sample(x.x, x.y, x.z, x.w));
}

// Closes the block.
@compute @workgroup_size(64)
fn merge_block(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let at = cell_of_sums(invocation(group, groups, local));
    if (at.outside) {
        return;
    }
    for (var k = 0u; k < 11u; k++) { // unroll
        set_statistic(k, at.scalar, merged(k, at.scalar));
    }
    for (var k = 11u; k < 22u; k++) { // unroll
        set_statistic(k, at.scalar, 0.0);
    }
}

// A mean or a covariance as a field.
@compute @workgroup_size(64)
fn write_statistic(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let at = cell_of_sums(invocation(group, groups, local));
    if (at.outside) {
        return;
    }
    derived[at.cell.x + CELLS_X * (at.cell.y + CELLS_Y * at.cell.z)] = merged(statistics_pass.plane, at.scalar);
}
