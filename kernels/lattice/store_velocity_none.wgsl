// The velocity is not needed.
// needs velocity, grid

fn store_velocity(p: Place, cell: u32, u: Vector) {
}
