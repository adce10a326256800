//! From what a search in f32 found to the list: exact, and in its order.

use super::Aabb;

/// Sorts pairs (i, j), i < j, by counting, linear in boxes and pairs, and takes those whose boxes
/// overlap in f64.
pub(super) fn exact(aabbs: &[Aabb], found: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let mut ends = vec![0; aabbs.len() + 1];
    for [first, _] in found {
        ends[*first as usize + 1] += 1;
    }
    for n in 0..aabbs.len() {
        ends[n + 1] += ends[n];
    }
    // The start of each row moves to its end as the row is filled.
    let mut seconds = vec![0; found.len()];
    for [first, second] in found {
        let end = &mut ends[*first as usize];
        seconds[*end] = *second;
        *end += 1;
    }
    let mut list = Vec::with_capacity(found.len());
    let mut start = 0;
    for ((number, item), end) in (0..).zip(aabbs).zip(ends) {
        let row = &mut seconds[start..end];
        row.sort_unstable();
        let exact = row.iter().filter(|j| item.overlaps(&aabbs[**j as usize]));
        list.extend(exact.map(|j| [number, *j]));
        start = end;
    }
    list
}
