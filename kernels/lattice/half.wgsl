// Two numbers in 16 bits each (IEEE 754 binary16), rounded up or down with a probability by the distance from either (stochastic
// rounding; Croci et al. 2022, R. Soc. Open Sci. 9:211631): the rounding to the nearest loses changes below half a bit, and slow
// diffusion with them. The pseudo-random number is a product of the bits of the number itself, without its sign, plus one, so
// that it is 0 for the NaN 0x7fffffff of some GPUs, which would overflow.

fn pack_half(value: vec2<f32>) -> u32 {
    let bits = bitcast<vec2<u32>>(value);
    let random = (bits * 0x3c6ef362u + 0x3c6ef362u) >> vec2(19u);
    return pack2x16float(bitcast<vec2<f32>>((bits + random) & vec2(0xffffe000u)));
}
