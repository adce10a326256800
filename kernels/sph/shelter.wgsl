// What a particle of water has of bodies beside it.

struct Shelter {
    // 1 if a particle of a shell is near it.
    near: u32,
    // Work on it in this step of particles of shells, beyond what their bodies did.
    pressed: f32,
    // Work on it in this step of what pushes it out of a body.
    pushed: f32,
}
