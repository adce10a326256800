// A workgroup a tile: its reads are neighbours in memory.
// needs cell_load, sum_of_all

fn sum_tile(index: u32, local: u32) {
    let here = index < tile_count();
    if (here) {
        let tile = tiles[index];
        let motion = motions[tile.block];
        let reach = reach_of(tile.inside);
        for (var l = reach.x + local; l < reach.y; l += 64u) {
            add_cell(tile, motion, index, l);
        }
    }
    let sum = sum_of_all(local);
    if (here && local < WRENCH) {
        partials[index * WRENCH + local] = sum;
    }
}
