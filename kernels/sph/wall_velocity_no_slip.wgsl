// Adami, Hu & Adams 2012, J. Comput. Phys. 231:7057, eqs. 22 and 23: the velocity of the water at a wall,
// extrapolated to its boundary particles for no slip at the surface.

@group(0) @binding(7) var<storage, read_write> wall_velocities_out: array<vec4<f32>>;

var<private> velocity_sum: vec3<f32>;

fn add_wall_velocity(w: f32, velocity: vec3<f32>) {
    velocity_sum += w * velocity;
}

fn store_wall_velocity(n: u32, no_slip: f32, wall: vec3<f32>) {
    let fluid = select(wall, velocity_sum / weights, weights > 0.0);
    wall_velocities_out[n] = vec4(2.0 * wall - fluid, no_slip);
}
