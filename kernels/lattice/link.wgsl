// Ladd 1994, J. Fluid Mech. 271:285: a population that has arrived behind a wall, and the location to which it returns.
// needs scalar_grid, scalars

// Scalar read, scalar written, the directions of both words as they are in an even step, and the number of scalars from this
// link to the next of its row: a vector, since software adapters read it in one access.
alias Link = vec4<u32>;

fn in_step(direction: u32) -> u32 {
    return ((direction - 1u) ^ cell_pass.odd) + 1u;
}

// The link of the same row, k links further on.
fn later_in_row(link: Link, k: u32) -> Link {
    return Link(link.x + k * link.w, link.y + k * link.w, link.z, link.w);
}

fn read_arrived(link: Link) -> f32 {
    return read_scalar(in_step(link.z & 31u), link.x);
}

fn write_returned(link: Link, value: f32) {
    write_scalar(in_step(link.z >> 5u), link.y, value);
}
