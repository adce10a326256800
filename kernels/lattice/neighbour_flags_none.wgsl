// Every cell is fluid and has fluid neighbours.

fn flags_of(cell: vec3<u32>) -> u32 {
    return 0u;
}
