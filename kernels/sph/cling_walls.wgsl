// Adami, Hu & Adams 2012, J. Comput. Phys. 231:7057, eqs. 22 and 23: the velocity of the water beside a wall, continued
// into it so that water rests at its surface.

@group(0) @binding(7) var<storage, read_write> clinging_out: array<vec4<f32>>;

var<private> carried: vec3<f32>;

fn meet_velocity(w: f32, velocity: vec3<f32>) {
    carried += w * velocity;
}

fn keep_velocity(n: u32, clings: f32, wall: vec3<f32>) {
    let beside = select(wall, carried / weights, weights > 0.0);
    clinging_out[n] = vec4(2.0 * wall - beside, clings);
}
