// Green 2010, Particle simulation using CUDA, first step of a counting sort: the number of particles in each cell.
// needs invocation, cell_grid, clock

@group(0) @binding(0) var<storage, read> unsorted: array<Particle>;
// One for each cell, one for escaped particles, and a last one that stays zero.
@group(0) @binding(1) var<storage, read_write> counts: array<atomic<u32>>;
// Arrival order of each particle in its cell, which depends on the device.
@group(0) @binding(2) var<storage, read_write> arrivals: array<u32>;
@group(0) @binding(3) var<storage, read> clock: Clock;

@compute @workgroup_size(64)
fn sort_count(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= arrayLength(&unsorted) || clock.stale == 0u) {
        return;
    }
    arrivals[n] = atomicAdd(&counts[cell_number(unsorted[n].at)], 1u);
}
