// Wendland 1995, Adv. Comput. Math. 4:389, the function C2 with support 2h.

// h, spacings.
override SMOOTHING: f32;
// 21/(16 pi h^3) in space, 7/(4 pi h^2) in a plane.
override KERNEL_SCALE: f32;

// W at the distance r.
fn weight(r: f32) -> f32 {
    let q = r / SMOOTHING;
    let a = max(1.0 - 0.5 * q, 0.0);
    return KERNEL_SCALE * a * a * a * a * (2.0 * q + 1.0);
}

// -W'(r)/r: the gradient of W at one end of r is -slope(r) r.
fn slope(r: f32) -> f32 {
    let a = max(1.0 - 0.5 * r / SMOOTHING, 0.0);
    return 5.0 * KERNEL_SCALE / (SMOOTHING * SMOOTHING) * a * a * a;
}
