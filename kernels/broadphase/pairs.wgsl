// Williams, Perkins & Cook 2004, Eng. Comput. 21:235, CGRID, with a grid for each size: the pairs of each box with the
// later boxes of its level and with those of coarser levels.
// needs invocation, boxes, $found

// Boxes, sorted by bucket.
@group(0) @binding(0) var<storage, read> entries: array<Box>;
// Index of the first box of each bucket, and the total number of boxes.
@group(0) @binding(1) var<storage, read> starts: array<u32>;
// Lowest group, with its bits inverted, and highest group of each bucket.
@group(0) @binding(2) var<storage, read> groups_of: array<vec2<u32>>;
@group(0) @binding(3) var<storage, read> levels: array<Level>;

struct PairSearch {
    levels: u32,
    // Invocations per box: each tests SLICE of its candidates.
    slices: u32,
    // Index of the pair at the first position of the list.
    first_pair: u32,
}

@group(0) @binding(4) var<uniform> search: PairSearch;

// Candidates per invocation. Some adapters silently end loops after 65535 iterations; the loops over cells have at most 27
// iterations on each of some 200 levels.
override SLICE: u32;

@compute @workgroup_size(64)
fn pairs(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    let items = arrayLength(&entries);
    if (n >= items * search.slices || !begin(n)) {
        return;
    }
    let slice = n / items;
    let item = entries[n % items];
    let own = level_of(item);
    let home = cell_of(item.min, levels[own].scale);
    let first_mine = slice * SLICE;
    var passed = 0u;
    for (var level = own; level < search.levels; level++) {
        // The lower corner of a box that overlaps this one lies in one of these cells.
        let scale = levels[level].scale;
        let low = cell_of(item.min - levels[level].extent, scale);
        let high = cell_of(item.max, scale);
        for (var z = low.z; z <= high.z; z++) {
            for (var y = low.y; y <= high.y; y++) {
                for (var x = low.x; x <= high.x; x++) {
                    let at = vec3(x, y, z);
                    let beside = any(at != home);
                    if (level == own && beside && before(at, home)) {
                        continue;
                    }
                    let bucket = bucket_of(at, level, arrayLength(&groups_of));
                    if (all(groups_of[bucket] == vec2(~item.group, item.group))) {
                        continue;
                    }
                    let start = starts[bucket];
                    let size = starts[bucket + 1u] - start;
                    let first = start + min(size, max(first_mine, passed) - passed);
                    let end = start + min(size, max(first_mine + SLICE, passed) - passed);
                    for (var k = first; k < end; k++) {
                        let other = entries[k];
                        if (!overlap(item, other) || other.group == item.group) {
                            continue;
                        }
                        // Cells of other levels may share the bucket. So may other cells of this level, but their
                        // coordinates differ by multiples of 4, and at most 4 cells per axis are searched.
                        let there = level_of(other) == level;
                        let later = level > own || beside || number_of(other) > number_of(item);
                        if (there && later) {
                            found(number_of(item), number_of(other));
                        }
                    }
                    passed += size;
                }
            }
        }
    }
    finish(n, passed);
}

// Whether cell a comes before cell b.
fn before(a: vec3<i32>, b: vec3<i32>) -> bool {
    if (a.z != b.z) {
        return a.z < b.z;
    }
    if (a.y != b.y) {
        return a.y < b.y;
    }
    return a.x < b.x;
}
