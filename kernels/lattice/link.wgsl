// Ladd 1994, J. Fluid Mech. 271:285: a population that has arrived behind a wall, and the location to which it returns.
// needs scalar_grid, scalars

// Scalar read, scalar written, and the directions of both words as they are in an even step.
struct Link {
    scalar_from: u32,
    scalar_to: u32,
    directions: u32,
}

fn in_step(direction: u32) -> u32 {
    return ((direction - 1u) ^ cell_pass.odd) + 1u;
}

fn read_arrived(link: Link) -> f32 {
    return read_scalar(in_step(link.directions & 31u), link.scalar_from);
}

fn write_returned(link: Link, value: f32) {
    write_scalar(in_step(link.directions >> 5u), link.scalar_to, value);
}
