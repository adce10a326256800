// A wall with a block within five cells in the previous step has no wall model: marks of mark_blocks.wgsl.

@group(0) @binding(44) var<storage, read> wall_blocks: array<u32>;

fn has_block(n: u32) -> bool {
    return wall_blocks[n] != 0u;
}
