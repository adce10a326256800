// Faces of convex parts over cells.

// Outward unit normal, and distance from the part's centroid.
@group(0) @binding(6) var<storage, read> faces: array<vec4<f32>>;

// Height over a cell's corner within which a face does not cut it, cells: the rounding of heights some 100 cells from
// the centroid. Faces that lie along the grid then cost nothing.
const TOUCH = 1e-5;
// A solid fraction that is all rounding.
const EMPTY = 1e-6;

// How far the corners of a cell are from its centre along n.
fn half_width(n: vec3<f32>) -> f32 {
    return 0.5 * (abs(n.x) + abs(n.y) + abs(n.z));
}

// The plane at the height s below the centre of a cell, from its lower corner.
fn plane_from_corner(n: vec3<f32>, s: f32) -> vec4<f32> {
    return vec4(n, dot(n, vec3(0.5)) - s);
}
