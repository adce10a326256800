// Verlet 1967, Phys. Rev. 159:98: the water within the support of each particle of a shell, for several steps.
// needs invocation, particle_grid, $runs, clock_shared, near, list_water

@group(0) @binding(2) var<storage, read> shell: array<Particle>;
@group(0) @binding(5) var<storage, read_write> near_counts_out: array<vec2<u32>>;
@group(0) @binding(6) var<storage, read_write> clock: ClockShared;

@compute @workgroup_size(64)
fn shell_neighbours(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = particle_of(invocation(group, groups, local));
    if (n >= arrayLength(&shell) || clock.step == 0.0 || clock.stale == 0u) {
        return;
    }
    let at = shell[n].at;
    if (at.x < 0) {
        near_counts_out[n] = vec2(0u);
        return;
    }
    let count = list_water(at, near_first(n));
    near_counts_out[n] = vec2(min(count, CAPACITY));
    if (count > CAPACITY) {
        atomicMax(&clock.shell_crowd, count);
    }
}
