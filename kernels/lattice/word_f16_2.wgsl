// Two cells per word: the lower one in the low half.
// needs half, lanes_2

fn pack(value: Real) -> u32 {
    return pack_half(value);
}

fn unpack(word: u32) -> Real {
    return unpack2x16float(word);
}
