// Green 2010, Particle simulation using CUDA, counting sort: particle indices by cell, in the order of arrival.
// needs invocation, cell_grid, clock

@group(0) @binding(0) var<storage, read> unsorted: array<Particle>;
// Number of particles in the cells before each cell.
@group(0) @binding(1) var<storage, read> starts: array<u32>;
@group(0) @binding(2) var<storage, read> arrivals: array<u32>;
@group(0) @binding(3) var<storage, read_write> list: array<u32>;
@group(0) @binding(4) var<storage, read> clock: Clock;

@compute @workgroup_size(64)
fn sort_scatter(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= arrayLength(&unsorted) || clock.stale == 0u) {
        return;
    }
    list[starts[cell_number(unsorted[n].at)] + arrivals[n]] = n;
}
