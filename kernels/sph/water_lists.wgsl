// The particles of the water around one, from a list that is made once for all that want it.
// needs particle_grid, $runs, near

@group(0) @binding(10) var<storage, read> near: array<u32>;
// Of each particle those of the water, and all.
@group(0) @binding(11) var<storage, read> near_counts: array<vec2<u32>>;

fn around_water(n: u32, at: vec3<i32>) {
    let first = near_first(n);
    let count = near_counts[n].x;
    for (var k = 0u; k < count; k++) {
        meet_water(near[first + 64u * k]);
    }
}
