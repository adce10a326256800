// Scardovelli & Zaleski 2000, J. Comput. Phys. 164:228, eqs. 4-8: volume of a unit cell below one plane.

// The plane is s (along its unit normal n) below the centre of the cell; w = |n|_1 / 2, |s| <= w.
fn one_plane_volume(n: vec3<f32>, s: f32, w: f32) -> f32 {
    let m = abs(n) / (2.0 * w);
    let low = min(min(m.x, m.y), m.z);
    let high = max(max(m.x, m.y), m.z);
    let middle = max(1.0 - low - high, low);
    let a = clamp((w - s) / (2.0 * w), 0.0, 1.0);
    // By symmetry, only the smaller side is computed.
    let below = lower_half(min(a, 1.0 - a), vec3(low, middle, high));
    return select(below, 1.0 - below, a > 0.5);
}

// m.x x + m.y y + m.z z <= a in the unit cube, for m.x <= m.y <= m.z, m.x + m.y + m.z = 1, a <= 1/2. Differences of
// cubes are divided out analytically, so that m.x may be arbitrarily small.
fn lower_half(a: f32, m: vec3<f32>) -> f32 {
    if (a >= m.x + m.y) {
        return (a - 0.5 * (m.x + m.y)) / m.z;
    }
    if (a <= m.x) {
        return a * a * a / (6.0 * m.x * m.y * m.z);
    }
    let b = max(a - m.y, 0.0);
    let c = max(a - m.z, 0.0);
    // b and c are at most m.x, and zero if m.x is.
    let cubes = (b * b * b + c * c * c) / max(m.x, 1e-30);
    return (3.0 * a * (a - m.x) + m.x * m.x - cubes) / (6.0 * m.y * m.z);
}
