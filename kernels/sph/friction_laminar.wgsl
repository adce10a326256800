// Morris, Fox & Zhu 1997, J. Comput. Phys. 136:214, eqs. 22 and 31: laminar viscosity, and its bound on the step.

// Velocity with which a particle of a shell resists, and 1 where water clings to it.
@group(0) @binding(7) var<storage, read> clinging: array<vec4<f32>>;

// ν, in spacings times the speed of sound.
override VISCOSITY: f32 = 1.0;

// `share` is −(dW/dr)/r, the slope of the kernel function over both densities.
fn rub_water(share: f32, other: vec3<f32>) {
    rate -= 2.0 * VISCOSITY * share * (here.velocity - other);
}

fn rub_shell(j: u32, share: f32) {
    let wall = clinging[j];
    rate -= 2.0 * VISCOSITY * wall.w * share * (here.velocity - wall.xyz);
}

fn longest_step() -> f32 {
    return 0.125 * SMOOTHING * SMOOTHING / VISCOSITY;
}
