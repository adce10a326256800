// Four cells per 64-bit word, low halves first.
// needs half, lanes_4

fn pack(value: Real) -> u64 {
    return u64(pack_half(value.xy)) | (u64(pack_half(value.zw)) << 32u);
}

fn unpack(word: u64) -> Real {
    return vec4(unpack2x16float(u32(word)), unpack2x16float(u32(word >> 32u)));
}
