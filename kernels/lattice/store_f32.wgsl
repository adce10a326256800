// Populations in memory as they are computed: f - w in f32.
// needs $lanes

fn decode(word: Word) -> Real {
    return word;
}

fn encode(value: Real) -> Word {
    return value;
}
