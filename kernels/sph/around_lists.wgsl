// The particles around one, from a list that the step has made once for all that want it.
// needs particle_grid, $runs, near

@group(0) @binding(10) var<storage, read> near: array<u32>;
// Of each particle those of the water, and all.
@group(0) @binding(11) var<storage, read> near_counts: array<vec2<u32>>;

fn around(n: u32, at: vec3<i32>) {
    let first = near_first(n);
    let counts = near_counts[n];
    for (var k = 0u; k < counts.x; k++) {
        meet_water(near[first + 64u * k]);
    }
    for (var k = counts.x; k < counts.y; k++) {
        meet_shell(near[first + 64u * k]);
    }
}
