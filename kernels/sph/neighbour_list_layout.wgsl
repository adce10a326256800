// Layout of the neighbour lists: the lists of 64 consecutive particles are interleaved. Lists that exceed one binding
// are split into ranges of particles.

struct Range {
    first: u32,
    end: u32,
}

@group(0) @binding(12) var<uniform> range: Range;

// Square of the list radius: the support plus the skin.
override LIST_SQUARED: f32;
// Capacity of each list.
override CAPACITY: u32;

// Index of the particle of an invocation; the largest u32 if it has none.
fn particle_of(invocation: u32) -> u32 {
    let n = range.first + invocation;
    return select(0xffffffffu, n, n < range.end);
}

fn list_start(n: u32) -> u32 {
    let local = n - range.first;
    return (local / 64u) * 64u * CAPACITY + local % 64u;
}
