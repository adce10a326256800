// Inviscid water: no viscous term, and no bound on the step.

fn viscous_fluid(weight: f32, other: vec3<f32>) {
}

fn viscous_boundary(j: u32, weight: f32) {
}

fn longest_step() -> f32 {
    return NO_LIMIT;
}
