// How the bodies move that carry the shells: x = centre + F X, to second order in the time of an exchange.

struct Motion {
    // Centroid, quanta.
    centre: vec3<i32>,
    // Number of the first particle of its shell, and of the particles.
    first: u32,
    velocity: vec3<f32>,
    count: u32,
    acceleration: vec3<f32>,
    // 1 where water clings to it, 0 where it slides.
    clings: f32,
    // Columns of F and of its first and second derivative.
    turn_x: vec3<f32>,
    turn_y: vec3<f32>,
    turn_z: vec3<f32>,
    rate_x: vec3<f32>,
    rate_y: vec3<f32>,
    rate_z: vec3<f32>,
    change_x: vec3<f32>,
    change_y: vec3<f32>,
    change_z: vec3<f32>,
}

// A particle of a shell in its body.
struct Home {
    // From the centroid, in the body's frame, spacings.
    place: vec3<f32>,
    body: u32,
}

// The part of F X that turns with the body.
fn lever(motion: Motion, x: vec3<f32>) -> vec3<f32> {
    return motion.turn_x * x.x + motion.turn_y * x.y + motion.turn_z * x.z;
}

fn velocity_at(motion: Motion, x: vec3<f32>) -> vec3<f32> {
    return motion.velocity + motion.rate_x * x.x + motion.rate_y * x.y + motion.rate_z * x.z;
}

fn acceleration_at(motion: Motion, x: vec3<f32>) -> vec3<f32> {
    return motion.acceleration + motion.change_x * x.x + motion.change_y * x.y + motion.change_z * x.z;
}
