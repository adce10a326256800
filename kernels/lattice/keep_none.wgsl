// Nothing asks for the velocity.
// needs velocity, grid

fn keep_velocity(p: Place, cell: u32, u: Vector) {
}
