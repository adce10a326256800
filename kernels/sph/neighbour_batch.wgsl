// Volkov 2010, Better performance at lower occupancy: independent loads. A GPU loads several neighbours before it adds the
// first, and adds without branches, which would separate the loads. A CPU adapter visits one neighbour at a time.

// Number of neighbours that are loaded before the first of them is added, 4 at most.
override NEIGHBOURS_PER_BATCH: u32;

// Index k + i, or the last index before `end` if k + i is not before `end`.
fn clamped_index(k: u32, i: u32, end: u32) -> u32 {
    return select(min(k + i, end - 1u), k, i == 0u);
}

// Whether the index k + i is before `end`.
fn is_before(k: u32, i: u32, end: u32) -> bool {
    return (i == 0u) | (k + i < end);
}

// Whether a neighbour is added. In batches all are; a neighbour that is not inside must then contribute zero.
fn is_added(inside: bool) -> bool {
    return (NEIGHBOURS_PER_BATCH > 1u) | inside;
}
