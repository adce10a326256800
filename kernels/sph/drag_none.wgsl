// No friction on a shell.

fn drag(n: u32, share: f32, water: vec3<f32>) {
}
