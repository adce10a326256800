// A workgroup a tile: its reads are neighbours in memory.
// needs cell_load, sum_of_all

fn sum_tile(turn: u32, local: u32) {
    let here = turn < tile_count();
    if (here) {
        let tile = tiles[turn];
        for (var l = local; l < WORKGROUP; l += 64u) {
            add_cell(tile, turn, l);
        }
    }
    let sum = sum_of_all(local);
    if (here && local < WRENCH) {
        partials[turn * WRENCH + local] = sum;
    }
}
