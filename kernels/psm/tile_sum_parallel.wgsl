// A workgroup a segment: its reads are neighbours in memory, and its invocations are added up once for all of its tiles.
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
