//! Numbers drawn by a seed: the same on every machine.

/// A number in (0, 1) for `key` and `seed`: SplitMix64 (Steele, Lea & Flood 2014, OOPSLA, figure 15),
/// once for the seed and once for each word of the key.
pub(crate) fn uniform(seed: u64, key: &[i64]) -> f64 {
    let hash = key.iter().fold(mix(seed), |h, word| mix(h ^ *word as u64));
    // The middle of one of 2⁵³ intervals: never 0 and never 1.
    ((hash >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
}

fn mix(state: u64) -> u64 {
    let z = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
