// Morris, Fox & Zhu 1997, J. Comput. Phys. 136:214, eq. 22: what a particle of a shell feels of the friction of water.

// Velocity with which a particle of a shell resists, and 1 where water clings to it.
@group(0) @binding(7) var<storage, read> clinging: array<vec4<f32>>;

// ν, in spacings times the speed of sound.
override VISCOSITY: f32 = 1.0;

fn drag(n: u32, share: f32, water: vec3<f32>) {
    let wall = clinging[n];
    force += 2.0 * VISCOSITY * wall.w * share * (water - wall.xyz);
}
