// One workgroup per segment: its reads are contiguous, and the sums of its invocations are added once for all of its tiles.
// needs cell_load, sum_of_all

fn sum_segment(index: u32, local: u32) {
    let segment = segment_at(index);
    if (segment != NOTHING) {
        add_segment(segment, local, 64u);
    }
    let sum = sum_of_all(local);
    if (segment != NOTHING && local < WRENCH) {
        partials[index * WRENCH + local] = sum;
    }
}
