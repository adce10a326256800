// Every brick of the grid runs.

// Number of bricks.
override BRICKS: u32;

fn brick_count() -> u32 {
    return BRICKS;
}

fn brick_of(group: u32) -> u32 {
    return group;
}
