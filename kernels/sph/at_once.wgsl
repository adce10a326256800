// Volkov 2010, Better performance at lower occupancy: loads that do not wait for each other. A GPU loads several neighbours
// before it adds the first, and adds without branches, which would part the loads. A CPU adapter takes one after the other.

// Neighbours that are loaded before the first of them is added, 4 at most.
override NEIGHBOURS_AT_ONCE: u32;

// Place k + i of the places up to `end`; for those beyond it the last one.
fn place_of(k: u32, i: u32, end: u32) -> u32 {
    return select(min(k + i, end - 1u), k, i == 0u);
}

// Whether that place is before `end`.
fn is_before(k: u32, i: u32, end: u32) -> bool {
    return (i == 0u) | (k + i < end);
}

// Whether a neighbour is added; one that is not inside must then count for nothing.
fn is_added(inside: bool) -> bool {
    return (NEIGHBOURS_AT_ONCE > 1u) | inside;
}
