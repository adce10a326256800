// Saturating addition, which is associative: a sum that is too large is detected and does not wrap.

fn saturating_add(a: u32, b: u32) -> u32 {
    let sum = a + b;
    return select(sum, 0xffffffffu, sum < a);
}
