// Asmuth et al. 2021, Phys. Fluids 33:105111: friction of a face at an angle to the grid. The full cells at such a face have
// reflected the populations that arrived. Those that now leave to the fluid get w c.m more, m along the face: the tangential momentum
// that arrived leaves again, less the stress of the law of the wall times the area of the face in the column of the cell. The
// surface of the full cells is a staircase; with m, the velocity of the solid along the face crosses its steps.
// needs sloping_cell, incoming, weights, $mirror

// Changes the populations that leave a full cell of a solid with this velocity; returns what the fluid gains.
fn exchange_at_slope(face: SlopingCell, cell: vec3<u32>, velocity: vec3<f32>, share: f32) -> vec3<f32> {
    let around = neighbourhood(cell);
    // Momentum of the populations that leave to the fluid, and the sum of w c c.
    var leaving = vec3(0.0);
    var columns: array<vec3<f32>, 3>;
    for (var q = 1u; q < 27u; q++) { // unroll
        if ((face.open & (1u << q)) != 0u) {
            let c = vec3<f32>(C[q]);
            let word = returned(around, face.slope, q);
            leaving += read_scalar(word.direction, word.scalar) * c;
            columns[0] += (weight(q) * f32(C[q].x)) * c;
            columns[1] += (weight(q) * f32(C[q].y)) * c;
            columns[2] += (weight(q) * f32(C[q].z)) * c;
        }
    }
    let weights = mat3x3(columns[0], columns[1], columns[2]);
    // Relative to the solid.
    leaving -= 3.0 * (weights * velocity);
    let speed = length(face.u);
    let is_top = (face.slope & SLOPE_TOP) != 0u;
    let area = select(0.0, 1.0 / abs(face.normal[(face.slope & 7u) / 2u]), is_top);
    let change = -2.0 * leaving - area * face.friction * face.friction / max(speed, 1e-30) * face.u;
    let m = tangential_solution(weights, face.normal, change);
    // Limits the velocity m/6 to twice the velocity that the law has read.
    let limited = share * min(1.0, 12.0 * speed / max(length(m), 1e-30)) * m;
    var gained = vec3(0.0);
    for (var q = 1u; q < 27u; q++) { // unroll
        if ((face.open & (1u << q)) != 0u) {
            let more = weight(q) * dot(vec3<f32>(C[q]), limited);
            let word = returned(around, face.slope, q);
            write_scalar(word.direction, word.scalar, read_scalar(word.direction, word.scalar) + more);
            gained += more * vec3<f32>(C[q]);
        }
    }
    return gained;
}

// The vector m normal to n for which the part of M m normal to n is that of b. M is singular where few directions are open; b is
// then in its range up to rounding.
fn tangential_solution(matrix: mat3x3<f32>, n: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    let other = select(vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), abs(n.x) > 0.6);
    let first = normalize(cross(n, other));
    let second = cross(n, first);
    let by_first = matrix * first;
    let by_second = matrix * second;
    let a = dot(first, by_first);
    let mixed = dot(first, by_second);
    let d = dot(second, by_second);
    let wanted = vec2(dot(first, b), dot(second, b));
    // λ/(λ² + s²) instead of 1/λ for both eigenvalues λ: adj(M) det M + s² M over the product of λ² + s².
    let determinant = a * d - mixed * mixed;
    let adjugate = vec2(d * wanted.x - mixed * wanted.y, a * wanted.y - mixed * wanted.x);
    let product = vec2(a * wanted.x + mixed * wanted.y, mixed * wanted.x + d * wanted.y);
    let s = SMALLEST * SMALLEST;
    let squares = determinant * determinant + s * (a * a + d * d + 2.0 * mixed * mixed) + s * s;
    let solved = (determinant * adjugate + s * product) / squares;
    return solved.x * first + solved.y * second;
}

// Eigenvalues of M below this count as 0: the part of b there is rounding. One direction along the face has 1/216 or more.
const SMALLEST = 1e-5;
