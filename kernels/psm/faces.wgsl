// Faces of convex parts, relative to cells.

// Outward unit normal, and distance from the part's centroid.
@group(0) @binding(6) var<storage, read> faces: array<vec4<f32>>;

// Distance between a face and a cell's corner, cells, within which the face does not cut the cell: the rounding of heights
// some 100 cells from the centroid. Faces along the grid then cost nothing.
const TOUCH = 1e-5;
// Solid fraction within rounding of zero.
const EMPTY = 1e-6;

// Largest distance of a cell's corners from its centre along n.
fn half_width(n: vec3<f32>) -> f32 {
    return 0.5 * (abs(n.x) + abs(n.y) + abs(n.z));
}

// The plane at the distance s below the centre of a cell, relative to the cell's lower corner.
fn plane_from_corner(n: vec3<f32>, s: f32) -> vec4<f32> {
    return vec4(n, dot(n, vec3(0.5)) - s);
}
