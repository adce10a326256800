// No body force.

fn cell_force(cell: vec3<u32>) -> vec3<f32> {
    return vec3(0.0);
}
