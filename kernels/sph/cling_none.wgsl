// Walls along which water slides.

fn meet_velocity(w: f32, velocity: vec3<f32>) {
}

fn keep_velocity(n: u32, clings: f32, wall: vec3<f32>) {
}
