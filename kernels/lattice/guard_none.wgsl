// Nobody watches: for measuring what the guard costs.
// needs velocity, grid

fn guard(p: Place, cell: u32, rho: Real, u: Vector) {
}
