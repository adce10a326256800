// Addition that stops at the largest number, still associative: a sum that is too large is seen, not wrapped.

fn saturating_add(a: u32, b: u32) -> u32 {
    let sum = a + b;
    return select(sum, 0xffffffffu, sum < a);
}
