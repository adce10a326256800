// Williams, Perkins & Cook 2004, Eng. Comput. 21:235, CGRID, first step: the number of boxes whose lower corner lies in
// the cells of each bucket, and the range of their groups.
// needs invocation, boxes

@group(0) @binding(0) var<storage, read> boxes: array<Box>;
@group(0) @binding(1) var<storage, read> levels: array<Level>;
// One per bucket, and a last one that stays zero.
@group(0) @binding(2) var<storage, read_write> counts: array<atomic<u32>>;
// Rank of each box in its bucket; the order depends on the device.
@group(0) @binding(3) var<storage, read_write> ranks: array<u32>;
// Lowest group, with its bits inverted, and highest group of each bucket; both begin at zero.
@group(0) @binding(4) var<storage, read_write> groups_in: array<array<atomic<u32>, 2>>;

@compute @workgroup_size(64)
fn bin_count(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= arrayLength(&boxes)) {
        return;
    }
    let item = boxes[n];
    let level = level_of(item);
    let cell = cell_of(item.min, levels[level].scale);
    let bucket = bucket_of(cell, level, arrayLength(&groups_in));
    ranks[n] = atomicAdd(&counts[bucket], 1u);
    atomicMax(&groups_in[bucket][0], ~item.group);
    atomicMax(&groups_in[bucket][1], item.group);
}
