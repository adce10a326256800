// Walls without a viscous term.

fn add_wall_velocity(w: f32, velocity: vec3<f32>) {
}

fn store_wall_velocity(n: u32, no_slip: f32, wall: vec3<f32>) {
}
