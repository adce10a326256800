// Populations are stored as they are computed: f - w in f32.
// needs $lanes, $reals

fn decode(word: Word) -> Real {
    return unpack_reals(word);
}

fn encode(value: Real) -> Word {
    return pack_reals(value);
}
