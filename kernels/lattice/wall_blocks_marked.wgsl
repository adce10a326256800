// Where a block was within five cells of a wall in the step before, the wall has no model: what mark_blocks.wgsl has found.

@group(0) @binding(44) var<storage, read> wall_blocks: array<u32>;

fn has_block(n: u32) -> bool {
    return wall_blocks[n] != 0u;
}
