// Power of the centre of a cell with respect to a sphere (Steiner 1826), R^2 - |r|^2: positive inside.
// needs tables

// Larger radii, cells, overflow squares of integers.
const MAX_WHOLE_RADIUS = 16384.0;

// Whole cells and fractions of a cell are multiplied separately: the squares that cancel are exact, so that the error is
// 1e-7 R, not 1e-7 R^2.
fn sphere_power(part: Part, cell: vec3<i32>) -> f32 {
    let whole = cell - part.base;
    let n = vec3<f32>(whole);
    let f = 0.5 - part.fraction;
    let whole_radius = floor(part.radius);
    let rest = part.radius - whole_radius;
    if (part.radius > MAX_WHOLE_RADIUS) {
        let distance = length(n + f);
        return (part.radius - distance) * (part.radius + distance);
    }
    let k = i32(whole_radius);
    let squares = k * k - (whole.x * whole.x + whole.y * whole.y + whole.z * whole.z);
    return f32(squares) + (2.0 * (whole_radius * rest - dot(n, f)) + (rest * rest - dot(f, f)));
}
