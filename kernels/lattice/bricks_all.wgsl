// Every brick of the grid runs.

// How many there are.
override BRICKS: u32;

fn brick_count() -> u32 {
    return BRICKS;
}

fn brick_of(group: u32) -> u32 {
    return group;
}
