// Guo, Zheng & Shi 2002: one force per volume everywhere, lattice units; it may change from step to step.
// needs velocity, grid

@group(0) @binding(69) var<uniform> uniform_force: vec4<f32>;

fn body_force(p: Place) -> Vector {
    return Vector(Real(uniform_force.x), Real(uniform_force.y), Real(uniform_force.z));
}
