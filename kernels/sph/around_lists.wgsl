// The particles around one, from a list that is made once for all that want it.
// needs near, water_lists

fn around(n: u32, at: vec3<i32>) {
    around_water(n, at);
    let first = near_first(n);
    let counts = near_counts[n];
    for (var k = counts.x; k < counts.y; k++) {
        meet_shell(near[first + 64u * k]);
    }
}
