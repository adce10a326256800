// Geraili Mikola & Sitar 2014, eq. 22: penalty force of a body on a particle inside it, (K_S d - K_D v.n) n.
// needs cell_grid, $cell_ranges, bodies, clock

// A convex part of a body, in the body's frame.
struct Hull {
    // Centre and radius of the bounding sphere, spacings; a hull without faces is that sphere.
    centre: vec3<f32>,
    radius: f32,
    body: u32,
    first_face: u32,
    // Number of its faces, and of the exposed ones, which come first; the others are internal.
    faces: u32,
    exposed: u32,
}

@group(0) @binding(6) var<storage, read> motions: array<BodyMotion>;
@group(0) @binding(7) var<storage, read> hulls: array<Hull>;
// Outward normal and distance from the centroid of the body.
@group(0) @binding(8) var<storage, read> planes: array<vec4<f32>>;

override PENALTY_STIFFNESS: f32;
override PENALTY_DAMPING: f32;

// Acceleration of the particle by the hull, with the body at its position `elapsed` after the start of the exchange.
fn penalty(hull: Hull, at: vec3<i32>, velocity: vec3<f32>, elapsed: f32) -> vec3<f32> {
    let motion = motions[hull.body];
    let offset = separation(at, wrapped(motion.centre)) - elapsed * motion.velocity;
    // In the frame of the body: F is a rotation.
    let x = vec3(dot(motion.deformation_x, offset), dot(motion.deformation_y, offset), dot(motion.deformation_z, offset));
    let from_centre = x - hull.centre;
    if (dot(from_centre, from_centre) > hull.radius * hull.radius) {
        return vec3(0.0);
    }
    // The particle leaves through the nearest exposed face.
    var highest = -1e30;
    var outward = vec3(0.0);
    let first_internal = hull.first_face + hull.exposed;
    for (var k = hull.first_face; k < first_internal; k++) {
        let height = dot(planes[k].xyz, x) - planes[k].w;
        if (height > highest) {
            highest = height;
            outward = planes[k].xyz;
        }
    }
    for (var k = first_internal; k < hull.first_face + hull.faces; k++) {
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
    // The force is repulsive only.
    return max(-PENALTY_STIFFNESS * highest - PENALTY_DAMPING * approach, 0.0) * n;
}
