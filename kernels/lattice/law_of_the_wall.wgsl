// Nikuradse 1933, VDI-Forschungsheft 361: the stress of a smooth or rough wall by a law of the wall, and the share of the law.
// needs $wall_law

const KARMAN = 0.4;
// y+ of the first cell up to which the wall is no-slip, and from which the law acts fully.
const NO_SLIP_UP_TO = 3.0;
const FULL_FROM = 6.0;

// Stress over density, of a smooth or rough wall: the log law of Nikuradse 1933 if its stress is larger.
fn law_of_the_wall(u: f32, y: f32, roughness: f32) -> f32 {
    let smooth_wall = smooth_wall_stress(u, y);
    let friction = KARMAN * u / log(max(30.0 * y / max(roughness, 1e-6), 2.0));
    return select(smooth_wall, max(smooth_wall, friction * friction), roughness > 0.0);
}

// Share of the law at a friction velocity.
fn model_share(friction: f32) -> f32 {
    let s = clamp((0.5 * friction / VISCOSITY - NO_SLIP_UP_TO) / (FULL_FROM - NO_SLIP_UP_TO), 0.0, 1.0);
    return s * s * (3.0 - 2.0 * s);
}
