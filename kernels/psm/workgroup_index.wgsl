// Index of a workgroup in a dispatch that is folded over two dimensions.

fn workgroup_index(group: vec3<u32>, groups: vec3<u32>) -> u32 {
    return group.x + group.y * groups.x;
}
