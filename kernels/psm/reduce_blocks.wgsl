// Gardner & Sitar 2018, eqs. 11-12: the sum over the segments of each block, in a fixed order. One workgroup per block.
// needs workgroup_index, sum_of_all

// Number of segments before each block, and of all.
@group(0) @binding(0) var<storage, read> block_first: array<u32>;
// WRENCH numbers per segment.
@group(0) @binding(1) var<storage, read> partials: array<f32>;
// WRENCH numbers per block.
@group(0) @binding(2) var<storage, read_write> wrenches: array<f32>;

@compute @workgroup_size(64)
fn reduce_blocks(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let block = workgroup_index(group, groups);
    let here = block + 1u < arrayLength(&block_first);
    if (here) {
        for (var segment = block_first[block] + local; segment < block_first[block + 1u]; segment += 64u) {
            for (var k = 0u; k < 20u; k++) { // unroll
                wrench[k] += partials[segment * WRENCH + k];
            }
        }
    }
    let sum = sum_of_all(local);
    if (here && local < WRENCH) {
        wrenches[block * WRENCH + local] = sum;
    }
}
