// Morris, Fox & Zhu 1997, J. Comput. Phys. 136:214, eq. 22: viscous force of the water on a boundary
// particle.

// Velocity of the boundary particle for the viscous term, and 1 for no slip.
@group(0) @binding(7) var<storage, read> wall_velocities: array<vec4<f32>>;

// ν, in spacings times the speed of sound.
override VISCOSITY: f32;

fn drag(n: u32, weight: f32, velocity: vec3<f32>) {
    let wall = wall_velocities[n];
    force += 2.0 * VISCOSITY * wall.w * weight * (velocity - wall.xyz);
}
