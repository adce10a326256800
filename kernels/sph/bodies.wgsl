// Motion of the bodies that carry the boundary particles: x = centre + F X, to second order in the time of an exchange.

struct BodyMotion {
    // Centroid, quanta.
    centre: vec3<i32>,
    // Index of its first boundary particle.
    first: u32,
    velocity: vec3<f32>,
    // Number of its boundary particles.
    count: u32,
    acceleration: vec3<f32>,
    // 1 for a no-slip surface, 0 for free slip.
    no_slip: f32,
    // Columns of F and of its first and second derivative.
    deformation_x: vec3<f32>,
    deformation_y: vec3<f32>,
    deformation_z: vec3<f32>,
    deformation_rate_x: vec3<f32>,
    deformation_rate_y: vec3<f32>,
    deformation_rate_z: vec3<f32>,
    deformation_acceleration_x: vec3<f32>,
    deformation_acceleration_y: vec3<f32>,
    deformation_acceleration_z: vec3<f32>,
}

// Position of a boundary particle in its body.
struct ReferencePosition {
    // From the centroid, in the body's frame, spacings.
    position: vec3<f32>,
    body: u32,
}

// F X, the offset from the centroid.
fn lever(motion: BodyMotion, x: vec3<f32>) -> vec3<f32> {
    return motion.deformation_x * x.x + motion.deformation_y * x.y + motion.deformation_z * x.z;
}

fn velocity_at(motion: BodyMotion, x: vec3<f32>) -> vec3<f32> {
    return motion.velocity
        + motion.deformation_rate_x * x.x + motion.deformation_rate_y * x.y + motion.deformation_rate_z * x.z;
}

fn acceleration_at(motion: BodyMotion, x: vec3<f32>) -> vec3<f32> {
    return motion.acceleration
        + motion.deformation_acceleration_x * x.x
        + motion.deformation_acceleration_y * x.y
        + motion.deformation_acceleration_z * x.z;
}
