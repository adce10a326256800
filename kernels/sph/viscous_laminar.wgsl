// Morris, Fox & Zhu 1997, J. Comput. Phys. 136:214, eqs. 22 and 31: laminar viscosity, and its bound on the step.

// Velocity of the boundary particle for the viscous term, and 1 for no slip.
@group(0) @binding(7) var<storage, read> wall_velocities: array<vec4<f32>>;

// ν, in spacings times the speed of sound.
override VISCOSITY: f32;

// `weight` is -(dW/dr)/r over both densities.
fn viscous_fluid(weight: f32, other: vec3<f32>) {
    rate -= 2.0 * VISCOSITY * weight * (here.velocity - other);
}

fn viscous_boundary(j: u32, weight: f32) {
    let wall = wall_velocities[j];
    rate -= 2.0 * VISCOSITY * wall.w * weight * (here.velocity - wall.xyz);
}

fn longest_step() -> f32 {
    return 0.125 * SMOOTHING * SMOOTHING / VISCOSITY;
}
