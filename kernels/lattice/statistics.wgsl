// Chan, Golub & LeVeque 1983, Am. Stat. 37:242, eqs. 2.1: means and covariances over time of density and velocity, from
// blocks of samples that are shifted by the mean so far.
// needs scalar_grid, $sample

@group(0) @binding(54) var<storage, read_write> derived: array<f32>;
// For each group of 64 cells of the pass in turn: 4 means, 7 covariances, and for the open block 4 sums and 7 sums of
// products. The values of an invocation lie close together.
@group(0) @binding(56) var<storage, read_write> statistics: array<f32>;

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

const PLANES = 22u;
const SUMS = 11u;
const PRODUCTS = 15u;

fn place(plane: u32, n: u32) -> u32 {
    return (n / 64u * PLANES + plane) * 64u + n % 64u;
}

// The two factors of covariance k: density, xx, yy, zz, xy, yz, xz.
fn factors(k: u32) -> vec2<u32> {
    return select(vec2(k), vec2(k - 3u, k % 3u + 1u), k > 3u);
}

// A mean or covariance including the samples of the open block.
fn merged(plane: u32, n: u32) -> f32 {
    let before = statistics[place(plane, n)];
    let samples = statistics_pass.samples;
    let weight = statistics_pass.weight;
    if (samples == 0.0) {
        return before;
    }
    if (plane < 4u) {
        return before + weight * statistics[place(SUMS + plane, n)] / samples;
    }
    let pair = factors(plane - 4u);
    let shift = statistics[place(SUMS + pair.x, n)] / samples * (statistics[place(SUMS + pair.y, n)] / samples);
    let own = statistics[place(PRODUCTS + plane - 4u, n)] / samples - shift;
    return before + weight * (own + (1.0 - weight) * shift - before);
}

// The first sample is the mean so far.
@compute @workgroup_size(64)
fn begin_statistics(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= cell_pass.end - cell_pass.first) {
        return;
    }
    let x = sample(cell_pass.first + n);
    for (var k = 0u; k < 4u; k++) { // unroll
        statistics[place(k, n)] = x[k];
    }
    for (var k = 4u; k < 22u; k++) { // unroll
        statistics[place(k, n)] = 0.0;
    }
}

@compute @workgroup_size(64)
fn add_sample(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= cell_pass.end - cell_pass.first) {
        return;
    }
    let x = sample(cell_pass.first + n);
    var z = vec4(0.0);
    for (var k = 0u; k < 4u; k++) { // unroll
        z[k] = x[k] - statistics[place(k, n)];
        statistics[place(SUMS + k, n)] += z[k];
    }
    for (var k = 0u; k < 7u; k++) { // unroll
        let pair = factors(k);
        statistics[place(PRODUCTS + k, n)] += z[pair.x] * z[pair.y];
    }
}

// Closes the block.
@compute @workgroup_size(64)
fn merge_block(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= cell_pass.end - cell_pass.first) {
        return;
    }
    for (var k = 0u; k < 11u; k++) { // unroll
        statistics[place(k, n)] = merged(k, n);
    }
    for (var k = 11u; k < 22u; k++) { // unroll
        statistics[place(k, n)] = 0.0;
    }
}

// A mean or a covariance as a field.
@compute @workgroup_size(64)
fn write_statistic(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= cell_pass.end - cell_pass.first) {
        return;
    }
    derived[cell_pass.first + n] = merged(statistics_pass.plane, n);
}
