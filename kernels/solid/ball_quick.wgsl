// Whether a cell is in a sphere, beside it, or on its surface.
// needs tables

// r: the centre of the cell from that of the sphere.
fn ball_quick(r: vec3<f32>, radius: f32) -> f32 {
    let far = abs(r);
    if (length(max(far - 1.5, vec3(0.0))) >= radius) {
        return 0.0;
    }
    if (length(max(far - 0.5, vec3(0.0))) >= radius) {
        return NEAR;
    }
    if (length(far + 0.5) <= radius) {
        return select(1.0, DEEP, length(far + 2.5) <= radius);
    }
    return UNDECIDED;
}
