// Populations are stored as they are computed: f - w in f32.
// needs $lanes, $reals

fn decode(word: Word) -> Real {
    return get_reals(word);
}

fn encode(value: Real) -> Word {
    return put_reals(value);
}
