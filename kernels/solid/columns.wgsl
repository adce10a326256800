// Gauss & Legendre's rule with two points a panel: columns through a cell, their lengths exact.

// Half the distance of the two points, 1 / sqrt(12) of a panel.
const GAUSS = 0.28867513;

// Column i of n, an even number, from the middle of the cell. All weigh the same.
fn column(i: u32, n: u32) -> f32 {
    let panel = f32(i / 2u) + 0.5 + select(GAUSS, -GAUSS, i % 2u == 0u);
    return panel * 2.0 / f32(n) - 0.5;
}

// The axis along which r points most: surfaces seen from r = 0 are never steep on columns along it.
fn main_axis(r: vec3<f32>) -> u32 {
    let size = abs(r);
    if (size.x >= size.y && size.x >= size.z) {
        return 0u;
    }
    return select(2u, 1u, size.y >= size.z);
}

// The axes in the order that makes `axis` the last one.
fn turned(v: vec3<f32>, axis: u32) -> vec3<f32> {
    if (axis == 0u) {
        return v.yzx;
    }
    return select(v, v.zxy, axis == 1u);
}
