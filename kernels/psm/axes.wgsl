// The main axis of a vector.

// The axis of the largest component of r.
fn main_axis(r: vec3<f32>) -> u32 {
    let size = abs(r);
    if (size.x >= size.y && size.x >= size.z) {
        return 0u;
    }
    return select(2u, 1u, size.y >= size.z);
}

// The axes in the order that makes `axis` the last one.
fn permuted(v: vec3<f32>, axis: u32) -> vec3<f32> {
    if (axis == 0u) {
        return v.yzx;
    }
    return select(v, v.zxy, axis == 1u);
}
