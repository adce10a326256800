// No viscous force on boundary particles.

fn drag(n: u32, weight: f32, velocity: vec3<f32>) {
}
