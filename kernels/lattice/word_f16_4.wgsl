// Four cells in two words, low halves first.
// needs half, lanes_4

fn pack(value: Real) -> vec2<u32> {
    return vec2(pack_half(value.xy), pack_half(value.zw));
}

fn unpack(word: vec2<u32>) -> Real {
    return vec4(unpack2x16float(word.x), unpack2x16float(word.y));
}
