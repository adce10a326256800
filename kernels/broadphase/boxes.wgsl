// Axis-aligned boxes, sorted into grid levels by size.

struct Box {
    // Corners from the local origin, m.
    min: vec3<f32>,
    // Boxes of the same group never form pairs.
    group: u32,
    max: vec3<f32>,
    // Number of the item in the lower 24 bits, its level in the upper 8.
    tag: u32,
}

// The grid cells of the boxes of one size class; fine levels come first.
struct Level {
    // Cells per metre, a power of two, so that the multiplication is exact.
    scale: f32,
    // Longest edge of a box of this level, m.
    extent: f32,
}

fn number_of(item: Box) -> u32 {
    return item.tag & 0xffffffu;
}

fn level_of(item: Box) -> u32 {
    return item.tag >> 24u;
}

fn overlap(a: Box, b: Box) -> bool {
    return all(a.min <= b.max) && all(b.min <= a.max);
}

fn cell_of(corner: vec3<f32>, scale: f32) -> vec3<i32> {
    return vec3<i32>(floor(corner * scale));
}

// Teschner et al. 2003, VMV, spatial hashing, applied to blocks of 4 x 4 x 4 cells, so that neighbours are near in
// memory. The last steps mix the bits (Appleby's MurmurHash3). `buckets` is a power of two, at least 64.
fn bucket_of(cell: vec3<i32>, level: u32, buckets: u32) -> u32 {
    let block = vec3<u32>(cell >> vec3(2u));
    var h = (block.x * 73856093u) ^ (block.y * 19349663u) ^ (block.z * 83492791u) ^ (level * 2654435761u);
    h = (h ^ (h >> 16u)) * 0x85ebca6bu;
    h = (h ^ (h >> 13u)) * 0xc2b2ae35u;
    h = h ^ (h >> 16u);
    let inside = vec3<u32>(cell & vec3(3i));
    return (h * 64u + inside.z * 16u + inside.y * 4u + inside.x) & (buckets - 1u);
}
