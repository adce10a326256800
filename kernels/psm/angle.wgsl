// The angle of a vector: the accuracy that WGSL guarantees for atan2, 4096 ULP, is insufficient for volumes.

// Moshier 1989, Cephes, atanf, to 1e-7: the angle of (x, y) from the x axis, -pi..pi, odd in y.
fn angle(x: vec4<f32>, y: vec4<f32>) -> vec4<f32> {
    let least = min(abs(x), abs(y));
    let most = max(max(abs(x), abs(y)), vec4(1e-30));
    // Angles beyond pi/8 are expanded around pi/4.
    let wide = least > 0.41421356 * most;
    let q = select(least, least - most, wide) / select(most, least + most, wide);
    let z = q * q;
    let series = ((0.0805374449538 * z - 0.138776856032) * z + 0.199777106478) * z - 0.333329491539;
    var result = select(vec4(0.0), vec4(0.78539816), wide) + (series * z * q + q);
    result = select(result, 1.57079633 - result, abs(y) > abs(x));
    result = select(result, 3.14159265 - result, x < vec4(0.0));
    return select(result, -result, y < vec4(0.0));
}
