// Work of walls and bodies on a fluid particle in a step.

struct WallWork {
    // 1 if a boundary particle is near.
    near_boundary: u32,
    // Work of boundary particles beyond the work of their bodies.
    boundary_work: f32,
    // Work of the penalty force.
    penalty_work: f32,
}
