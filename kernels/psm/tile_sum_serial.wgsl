// An invocation a tile: no barriers, which cost a CPU more than the sum.
// needs cell_load

fn sum_tile(index: u32, local: u32) {
    let number = index * 64u + local;
    if (number >= tile_count()) {
        return;
    }
    let tile = tiles[number];
    let motion = motions[tile.block];
    let reach = reach_of(tile.inside);
    for (var l = reach.x; l < reach.y; l++) {
        add_cell(tile, motion, number, l);
    }
    for (var k = 0u; k < 20u; k++) { // unroll
        partials[number * WRENCH + k] = wrench[k];
    }
}
