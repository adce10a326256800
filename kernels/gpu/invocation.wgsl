// Index of an invocation in a dispatch of workgroups of 64 that is folded over two dimensions.

fn invocation(group: vec3<u32>, groups: vec3<u32>, local: u32) -> u32 {
    return (group.x + group.y * groups.x) * 64u + local;
}
