// Fluid cells whose neighbours are fluid.
// needs $lanes, velocity, grid

fn cell_class(p: Place) -> u32 {
    return 0u;
}

fn solid(cell: u32) -> Mask {
    return Mask(false);
}

fn next_to_wall(cell: u32) -> Mask {
    return Mask(false);
}

fn wall_at(p: Place, cell: u32, face: u32) -> Mask {
    return Mask(false);
}

fn clear_solid(cell: u32, h: ptr<function, array<Real, 27>>) {
}

fn still_in_solid(cell: u32, u: Vector) -> Vector {
    return u;
}

// Derivative along an axis from the values below, here and above; `face` is 0, 2 or 4 for x, y, z.
fn difference(cell: u32, face: u32, below: Real, here: Real, above: Real) -> Real {
    return 0.5 * (above - below);
}
