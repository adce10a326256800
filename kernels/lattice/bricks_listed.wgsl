// Only the listed bricks run. The list begins with its length, so that it may change from step to step.

@group(0) @binding(40) var<storage, read> bricks: array<u32>;

fn brick_count() -> u32 {
    return bricks[0u];
}

fn brick_of(group: u32) -> u32 {
    return bricks[1u + group];
}
