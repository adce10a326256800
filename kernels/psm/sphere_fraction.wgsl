// Fractions of a sphere in a cell on its surface.
//
// Along the main axis z the solid fraction is G(z0) - G(z1), where G(z) is the volume of the sphere above height z over the
// cell's square. With h = sqrt(R^2 - x^2 - y^2), u = max(h - z, 0), t = R - z and F(u) = u^2 (z/2 + u/3), the field
// (C - F) / rho^2 (x, y) has the divergence u for any C, so that by Gauss's theorem G is a sum over the edges of the square:
//     G = sum of +-a [ integral of (C - F) / rho^2 along the part of the edge in the sphere ] + C (angle of the rest),
// where a is the distance of the edge from the axis. Away from the axis C = 0: the surface adds nothing. Near it C = F(t),
// which makes the integrand (t + u) / 4 + (t - u)^2 / (12 (R + h)). All terms are of the size of a cell: there is no cancellation.
// needs tables, axes, sphere_power, angle, $effective

// Squared distance from the axis, cells^2, below which a square is near it; for spheres of more than 4 cells, the radius.
const AXIS = 4.0;
// Radius below which h ends like a square root within a cell.
const SMALL = 3.0;
const TINY = 1e-30;
// Solid fraction within rounding of zero.
const SPHERE_EMPTY = 1e-6;

// The cross-section of a cell at the height z over the sphere's equator; edges in the order right, left, upper, lower.
struct Square {
    radius: f32,
    z: f32,
    // Height of the sphere over the square on the axis.
    t: f32,
    near_axis: bool,
    // Distances of the edges from the axis, and of their middles along the edges.
    a: vec4<f32>,
    b: vec4<f32>,
    // Powers of the middles of the edges.
    power: vec4<f32>,
}

const SIDES = vec4(1.0, -1.0, 1.0, -1.0);

fn sphere_fraction(part: Part, cell: vec3<i32>) -> Fractions {
    // A loop, so that compilers do not inline sphere_volume twice.
    var ball = part;
    var solid = 0.0;
    var effective = 0.0;
    for (var n = 0u; n < 2u; n++) {
        effective = sphere_volume(ball, cell);
        let outer = effective_radius(ball.radius);
        if (n == 0u) {
            solid = effective;
        }
        if (outer == ball.radius) {
            break;
        }
        ball.radius = outer;
    }
    return Fractions(solid, vec2(effective));
}

fn sphere_volume(part: Part, cell: vec3<i32>) -> f32 {
    // By symmetry, mapped to the octant of positive coordinates.
    let far = abs(centre_from(cell, part.base, part.fraction));
    let at = permuted(far, main_axis(far));
    let power = sphere_power(part, cell);
    // A cell around the centre of the sphere extends to both sides of the equator.
    let middle = at.z < 0.5;
    var fraction = 0.0;
    for (var level = 0u; level < select(2u, 3u, middle); level++) {
        var z = at.z - 0.5;
        var middle_power = power + (at.z - 0.25);
        var weight = 1.0;
        if (level == 1u) {
            z = at.z + 0.5;
            middle_power = power - (at.z + 0.25);
            weight = -1.0;
        } else if (level == 2u) {
            z = -z;
            weight = -1.0;
        } else if (middle) {
            z = 0.0;
            middle_power = power + at.z * at.z;
            weight = 2.0;
        }
        fraction += weight * volume_above(at.xy, z, middle_power, part.radius);
    }
    return select(0.0, min(fraction, 1.0), fraction > SPHERE_EMPTY);
}

// at: middle of the square from the axis; power: the power of this middle.
fn volume_above(at: vec2<f32>, z: f32, power: f32, radius: f32) -> f32 {
    let a = at.xxyy + 0.5 * SIDES;
    let b = at.yyxx;
    let square = Square(
        radius,
        z,
        max(power + dot(at, at), 0.0) / (radius + z),
        dot(at, at) < max(AXIS, radius),
        a,
        b,
        power - (SIDES * at.xxyy + 0.25),
    );
    // The parts of the edges in the sphere, from their middles.
    let y = sqrt(max(square.power + b * b, vec4(0.0)));
    let low = clamp(-y - b, vec4(-0.5), vec4(0.5));
    let high = max(clamp(square.power / max(y + b, vec4(TINY)), vec4(-0.5), vec4(0.5)), low);
    let middle = 0.5 * (low + high);
    let half = 0.5 * (high - low);
    // Gauss-Legendre quadrature with four points; for small spheres with eight, in the variable p (3 - p^2) / 2, which
    // removes the power 3/2 at the ends.
    var line: vec4<f32>;
    if (radius < SMALL) {
        line = 0.011819959 * pair(square, middle, 0.997665966 * half)
            + 0.121861201 * pair(square, middle, 0.942186581 * half)
            + 0.340598687 * pair(square, middle, 0.715726711 * half)
            + 0.525720153 * pair(square, middle, 0.272065835 * half);
    } else {
        line = 0.347854845 * pair(square, middle, 0.861136312 * half)
            + 0.652145155 * pair(square, middle, 0.339981044 * half);
    }
    line *= half * a;
    if (square.near_axis && square.t > 0.0 && any(half < vec4(0.5))) {
        let c = square.t * square.t * (0.5 * z + square.t / 3.0);
        // The sum of the angles at both ends, as the product of two complex numbers.
        let low_x = a * a + (b - 0.5) * (b + low);
        let low_y = a * (low + 0.5);
        let high_x = a * a + (b + high) * (b + 0.5);
        let high_y = a * (0.5 - high);
        line += c * angle(low_x * high_x - low_y * high_y, low_x * high_y + low_y * high_x);
    }
    return dot(SIDES, line);
}

fn pair(square: Square, middle: vec4<f32>, away: vec4<f32>) -> vec4<f32> {
    return along(square, middle - away) + along(square, middle + away);
}

// (C - F) / rho^2 at one point per edge, at the distance `place` from its middle.
fn along(square: Square, place: vec4<f32>) -> vec4<f32> {
    let power = max(square.power - place * (2.0 * square.b + place), vec4(0.0));
    let h = sqrt(square.z * square.z + power);
    let u = power / max(h + square.z, vec4(TINY));
    if (square.near_axis) {
        let v = square.t - u;
        return 0.25 * (square.t + u) + v * v / (12.0 * (square.radius + h));
    }
    let y = square.b + place;
    return -u * u * (0.5 * square.z + u / 3.0) / (square.a * square.a + y * y);
}
