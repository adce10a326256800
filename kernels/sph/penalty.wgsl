// Geraili Mikola & Sitar 2014, eq. 22: the push of a body on a particle that is in it, (K_S d - K_D v.n) n.
// needs particle_grid, $runs, bodies, clock

// A convex part of a body, in the body's frame.
struct Hull {
    // Of its circumscribed sphere, spacings; a hull without faces is that sphere.
    centre: vec3<f32>,
    radius: f32,
    body: u32,
    first_face: u32,
    // Number of its faces, and of those, the first ones, that are not inside other parts of the body.
    faces: u32,
    bare: u32,
}

@group(0) @binding(6) var<storage, read> motions: array<Motion>;
@group(0) @binding(7) var<storage, read> hulls: array<Hull>;
// Outward normal and distance from the centroid of the body.
@group(0) @binding(8) var<storage, read> planes: array<vec4<f32>>;

override PENALTY_STIFFNESS: f32 = 0.25;
override PENALTY_DAMPING: f32 = 0.5;

// Acceleration of the particle by the hull, where the body is `elapsed` after the start of the exchange.
fn penalty(hull: Hull, at: vec3<i32>, velocity: vec3<f32>, elapsed: f32) -> vec3<f32> {
    let motion = motions[hull.body];
    let away = between(at, wrapped(motion.centre)) - elapsed * motion.velocity;
    // In the frame of the body: F is a rotation.
    let x = vec3(dot(motion.turn_x, away), dot(motion.turn_y, away), dot(motion.turn_z, away));
    let from_centre = x - hull.centre;
    if (dot(from_centre, from_centre) > hull.radius * hull.radius) {
        return vec3(0.0);
    }
    // The way out is through the nearest face that water may meet.
    var highest = -1e30;
    var outward = vec3(0.0);
    let seams = hull.first_face + hull.bare;
    for (var k = hull.first_face; k < seams; k++) {
        let height = dot(planes[k].xyz, x) - planes[k].w;
        if (height > highest) {
            highest = height;
            outward = planes[k].xyz;
        }
    }
    for (var k = seams; k < hull.first_face + hull.faces; k++) {
        if (dot(planes[k].xyz, x) > planes[k].w) {
            return vec3(0.0);
        }
    }
    if (hull.faces == 0u) {
        let distance = length(from_centre);
        highest = distance - hull.radius;
        outward = from_centre / max(distance, 1e-6);
    }
    if (highest >= 0.0 || highest < -1e29) {
        return vec3(0.0);
    }
    let n = lever(motion, outward);
    let approach = dot(velocity - velocity_at(motion, x), n);
    // Walls push and do not pull.
    return max(-PENALTY_STIFFNESS * highest - PENALTY_DAMPING * approach, 0.0) * n;
}
