// Williams, Perkins & Cook 2004, Eng. Comput. 21:235, CGRID, last step: the boxes sorted by bucket.
// needs invocation, boxes

@group(0) @binding(0) var<storage, read> boxes: array<Box>;
@group(0) @binding(1) var<storage, read> levels: array<Level>;
// Index of the first box of each bucket, and the total number of boxes.
@group(0) @binding(2) var<storage, read> starts: array<u32>;
@group(0) @binding(3) var<storage, read> ranks: array<u32>;
@group(0) @binding(4) var<storage, read_write> entries_out: array<Box>;

@compute @workgroup_size(64)
fn bin_scatter(
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
    let bucket = bucket_of(cell, level, arrayLength(&starts) - 1u);
    entries_out[starts[bucket] + ranks[n]] = item;
}
