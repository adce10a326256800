// Verlet 1967, Phys. Rev. 159:98: the particles of the water within the reach of a place, into a list.
// needs particle_grid, $runs, near

@group(0) @binding(0) var<storage, read> particles: array<Particle>;
@group(0) @binding(1) var<storage, read> starts: array<u32>;
@group(0) @binding(4) var<storage, read_write> near_out: array<u32>;

// Writes as many as there is room for, and says how many there are.
fn list_water(at: vec3<i32>, first: u32) -> u32 {
    let home = cell_of(at);
    var count = 0u;
    for (var k = 0; k < RUNS; k++) {
        let cells = run(home, k);
        for (var j = starts[cells.x]; j < starts[cells.y]; j++) {
            let r = between(at, particles[j].at);
            if (dot(r, r) < LIST_SQUARED) {
                if (count < CAPACITY) {
                    near_out[first + 64u * count] = j;
                }
                count++;
            }
        }
    }
    return count;
}
