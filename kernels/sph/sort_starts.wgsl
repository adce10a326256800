// Green 2010, Particle simulation using CUDA: index of the first particle of each cell, kept until the next sort.
// needs invocation, clock

@group(0) @binding(0) var<storage, read> new_starts: array<u32>;
@group(0) @binding(1) var<storage, read_write> starts: array<u32>;
@group(0) @binding(2) var<storage, read> clock: Clock;

@compute @workgroup_size(64)
fn sort_starts(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n < arrayLength(&starts) && clock.stale != 0u) {
        starts[n] = new_starts[n];
    }
}
