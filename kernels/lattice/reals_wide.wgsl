// Values of an element are stored two per 64-bit word: a CPU adapter that loops over its invocations for each
// word of an access then loops half as often.
// needs lanes_4

alias Reals = vec2<u64>;

fn unpack_reals(kept: Reals) -> Real {
    let low = vec2<u32>(kept);
    let high = vec2<u32>(kept >> vec2<u32>(32u));
    return bitcast<vec4<f32>>(vec4(low.x, high.x, low.y, high.y));
}

fn pack_reals(value: Real) -> Reals {
    let bits = bitcast<vec4<u32>>(value);
    return vec2<u64>(bits.xz) | (vec2<u64>(bits.yw) << vec2<u32>(32u));
}
