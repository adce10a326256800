// Lehmann et al. 2022, Phys. Rev. E 106:015308: shifted populations times 2^15 in IEEE half precision, which keeps
// their size (below 2) in its range and the small ones above its denormals.
// needs $lanes, $word

const SCALE = 32768.0;

fn decode(word: Word) -> Real {
    return unpack(word) * (1.0 / SCALE);
}

fn encode(value: Real) -> Word {
    return pack(value * SCALE);
}
