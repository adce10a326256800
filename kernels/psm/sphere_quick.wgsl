// Whether a cell is inside a sphere, next to it, or on its surface.
// needs tables, sphere_power, $effective

fn sphere_quick(part: Part, cell: vec3<i32>) -> f32 {
    let far = abs(centre_from(cell, part.base, part.fraction));
    var outer = part;
    outer.radius = effective_radius(part.radius);
    let power = sphere_power(outer, cell);
    if (nearest_power(power, far, 1.5) <= 0.0) {
        return 0.0;
    }
    if (nearest_power(power, far, 0.5) <= 0.0) {
        return NEAR;
    }
    let inner = power - (outer.radius - part.radius) * (outer.radius + part.radius);
    if (farthest_power(inner, far, 0.5) >= 0.0) {
        return select(1.0, INTERIOR, farthest_power(inner, far, 2.5) >= 0.0);
    }
    return UNDECIDED;
}

// Power of the nearest and of the farthest point of a cube around the cell's centre; `half` is half its edge. Differences
// of squares are multiplied out.
fn nearest_power(power: f32, far: vec3<f32>, half: f32) -> f32 {
    let gain = select(far * far, half * (2.0 * far - half), far > vec3(half));
    return power + (gain.x + gain.y + gain.z);
}

fn farthest_power(power: f32, far: vec3<f32>, half: f32) -> f32 {
    let loss = half * (2.0 * far + half);
    return power - (loss.x + loss.y + loss.z);
}
