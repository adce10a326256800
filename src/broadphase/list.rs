//! The list of pairs in its order, by counting: linear in items and pairs.

/// Sorts pairs (i, j), i < j < `items`.
pub(super) fn sort(items: usize, pairs: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let mut ends = vec![0; items + 1];
    for [first, _] in pairs {
        ends[*first as usize + 1] += 1;
    }
    for n in 0..items {
        ends[n + 1] += ends[n];
    }
    // The start of each row moves to its end as the row is filled.
    let mut sorted = vec![[0; 2]; pairs.len()];
    for pair in pairs {
        let end = &mut ends[pair[0] as usize];
        sorted[*end] = *pair;
        *end += 1;
    }
    let mut start = 0;
    for end in &ends[..items] {
        sorted[start..*end].sort_unstable();
        start = *end;
    }
    sorted
}
