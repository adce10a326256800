// Guo, Zheng & Shi 2002: one force per volume everywhere, lattice units.

override FORCE_X: f32;
override FORCE_Y: f32;
override FORCE_Z: f32;

fn cell_force(cell: vec3<u32>) -> vec3<f32> {
    return vec3(FORCE_X, FORCE_Y, FORCE_Z);
}
