// No blocks in the fluid.

fn has_block(n: u32) -> bool {
    return false;
}
