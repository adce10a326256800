// Lehmann 2022, Computation 10(6):92, Esoteric-Pull: streaming without collision. The memory traffic of a step without
// its arithmetic: a bound that no collision kernel of the same layout can beat.
// needs stream, $bricks, workgroup

@compute @workgroup_size(WORKGROUP)
fn stream_only(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let index = group.x + group.y * groups.x;
    if (index >= brick_count()) {
        return;
    }
    let p = place(brick_of(index), local);
    if (p.outside) {
        return;
    }
    var f = load(p);
    store(p, &f);
}
