// Verlet 1967, Phys. Rev. 159:98: the particles within the support of each, found once for all sums of several steps.
// needs invocation, particle_grid, $runs, clock_shared, near, list_water

@group(0) @binding(2) var<storage, read> shell: array<Particle>;
@group(0) @binding(3) var<storage, read> shell_starts: array<u32>;
@group(0) @binding(5) var<storage, read_write> near_counts_out: array<vec2<u32>>;
@group(0) @binding(6) var<storage, read_write> clock: ClockShared;

@compute @workgroup_size(64)
fn neighbours(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = particle_of(invocation(group, groups, local));
    if (n >= arrayLength(&particles) || clock.step == 0.0 || clock.stale == 0u) {
        return;
    }
    let at = particles[n].at;
    if (at.x < 0) {
        near_counts_out[n] = vec2(0u);
        return;
    }
    let first = near_first(n);
    let home = cell_of(at);
    var count = list_water(at, first);
    let water = count;
    for (var k = 0; k < RUNS; k++) {
        let cells = run(home, k);
        for (var j = shell_starts[cells.x]; j < shell_starts[cells.y]; j++) {
            let r = between(at, shell[j].at);
            if (dot(r, r) < LIST_SQUARED) {
                if (count < CAPACITY) {
                    near_out[first + 64u * count] = j;
                }
                count++;
            }
        }
    }
    near_counts_out[n] = min(vec2(water, count), vec2(CAPACITY));
    if (count > CAPACITY) {
        atomicMax(&clock.crowd, count);
    }
}
