// Lists of the particles around each: those of 64 particles next to each other are interleaved. They may be too long
// for one binding, and are then made for one range of particles after the other.

struct Range {
    first: u32,
    end: u32,
}

@group(0) @binding(12) var<uniform> range: Range;

// Square of what the lists reach: the support and the skin.
override LIST_SQUARED: f32 = 16.0;
// Room in each list.
override CAPACITY: u32 = 1;

// The number of the particle that an invocation is for; after all others if it is for none.
fn particle_of(invocation: u32) -> u32 {
    let n = range.first + invocation;
    return select(0xffffffffu, n, n < range.end);
}

fn near_first(n: u32) -> u32 {
    let local = n - range.first;
    return (local / 64u) * 64u * CAPACITY + local % 64u;
}
