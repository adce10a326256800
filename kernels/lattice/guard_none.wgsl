// No guard: for measuring its cost.
// needs $lanes, velocity, grid

fn out_of_range(cell: u32, rho: Real, u: Vector) -> Mask {
    return Mask(false);
}

fn guard(p: Place, bad: Mask, first: bool) {
}
