// Green 2010, Particle simulation using CUDA, last step of a counting sort: the particles by cell, and by id within a cell.
// The order of sums over them is then independent of the order of arrival.
// needs invocation, cell_grid, clock

@group(0) @binding(0) var<storage, read> unsorted: array<Particle>;
@group(0) @binding(1) var<storage, read> starts: array<u32>;
@group(0) @binding(2) var<storage, read> list: array<u32>;
@group(0) @binding(3) var<storage, read> arrivals: array<u32>;
@group(0) @binding(4) var<storage, read_write> sorted: array<Particle>;
@group(0) @binding(5) var<storage, read> clock: Clock;

@compute @workgroup_size(64)
fn sort_reorder(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= arrayLength(&unsorted)) {
        return;
    }
    let particle = unsorted[n];
    if (clock.stale == 0u) {
        // Keep the order of the last sort.
        sorted[n] = particle;
        return;
    }
    let cell = cell_number(particle.at);
    let first = starts[cell];
    if (particle.at.x < 0) {
        // Escaped particles enter no sum, and there may be many: they keep the order of arrival.
        sorted[first + arrivals[n]] = particle;
        return;
    }
    var rank = 0u;
    for (var k = first; k < starts[cell + 1u]; k++) {
        rank += select(0u, 1u, unsorted[list[k]].id < particle.id);
    }
    sorted[first + rank] = particle;
}
