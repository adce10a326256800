// Asmuth et al. 2021, Phys. Fluids 33:105111: friction of a face at an angle to the grid. The full cells at such a face have
// reflected the populations that arrived. Those that now leave to the fluid get w c.m more, m along the face: the tangential momentum
// that arrived leaves again, less the stress of the law of the wall times the area of the face in the column of the cell. The
// surface of the full cells is a staircase; with m, the velocity of the solid along the face crosses its steps. What one cell
// takes in, others give off: leaks proportional to the amounts, without momentum along the face, make the sum zero. The momentum
// that arrived is that without the pressure, of which single steps of the staircase have a part along the face, and without that of
// fluid at rest.
// needs sloping_cell, incoming, weights, balanced_cell_force, $mirror

// Sums of what the cells at such faces give off, and of its amounts: each in units of 2^-28 by the multiples of 4096 and the rest, so
// that the order does not matter. A million cells fit.
var<workgroup> slip_sums: array<atomic<i32>, 4>;

fn clear_slip_sums(local: u32) {
    if (local < 4u) {
        atomicStore(&slip_sums[local], 0);
    }
    workgroupBarrier();
}

fn add_to_slip_sums(face: SlopingCell) {
    let given = face.given;
    let units = i32(round(clamp(given, -1.0, 1.0) * 268435456.0));
    atomicAdd(&slip_sums[0u], units >> 12u);
    atomicAdd(&slip_sums[1u], units & 4095);
    let takes = select(0, abs(units), face.per_sum > 0.0);
    atomicAdd(&slip_sums[2u], takes >> 12u);
    atomicAdd(&slip_sums[3u], takes & 4095);
}

// What is given off over its amount, from these sums over all cells.
fn slip_balance(given: i32, rest: i32, amount: i32, rest_of_amount: i32) -> f32 {
    let sum = 4096.0 * f32(given) + f32(rest);
    return sum / max(4096.0 * f32(amount) + f32(rest_of_amount), 1.0);
}

// Sum of the weights of some directions, one bit each.
fn weight_of(directions: u32) -> f32 {
    return weight(1u) * f32(countOneBits(directions & 0x7eu))
        + weight(7u) * f32(countOneBits(directions & 0x7ff80u))
        + weight(19u) * f32(countOneBits(directions & 0x7f80000u));
}

// Excess of the density of a cell over that of fluid at rest, from the populations that its neighbours load next.
fn excess_density(cell: vec3<u32>) -> f32 {
    let at = neighbourhood(cell);
    var sum = read_scalar(0u, scalar_at(at, vec3(0)));
    for (var q = 1u; q < 27u; q++) { // unroll
        sum += read_outgoing(at, q);
    }
    return sum;
}

// Changes the face to that with the m of a full cell of a solid with this velocity, and with the sum that its populations get.
fn slip_at_slope(at: SlopingCell, cell: vec3<u32>, velocity: vec3<f32>, share: f32) -> SlopingCell {
    var face = at;
    let around = neighbourhood(cell);
    let at_rest = 1.5 * balanced_force(cell);
    // Sum and momentum of the populations that leave to the fluid, and the sums of w c and w c c.
    var sum = 0.0;
    var leaving = vec3(0.0);
    var outward = vec3(0.0);
    var columns: array<vec3<f32>, 3>;
    for (var q = 1u; q < 27u; q++) { // unroll
        if ((face.open & (1u << q)) != 0u) {
            let c = vec3<f32>(C[q]);
            let word = returned(around, face.slope, q);
            let f = read_scalar(word.direction, word.scalar) - weight(q) * dot(c, at_rest);
            sum += f;
            leaving += f * c;
            outward += weight(q) * c;
            columns[0] += (weight(q) * f32(C[q].x)) * c;
            columns[1] += (weight(q) * f32(C[q].y)) * c;
            columns[2] += (weight(q) * f32(C[q].z)) * c;
        }
    }
    let weights = mat3x3(columns[0], columns[1], columns[2]);
    let all = weight_of(face.open);
    // Relative to the solid.
    sum -= 3.0 * dot(outward, velocity);
    leaving -= 3.0 * (weights * velocity);
    // Of the deviation from the equilibrium of a solid that moves, full cells return a part only: see damping_in_full_cells.
    let kept = 1.0 - min(abs(velocity.x) + abs(velocity.y) + abs(velocity.z), 0.9);
    // Without the pressure, which is that of the column up to where the law has read the velocity.
    var excess = 0.0;
    if (kept > LEAST_KEPT) {
        // The mean over the column damps steady waves of a few cells that the steps send out.
        let outer = face.slope & 7u;
        let sample = cell_of_scalar(face.sample);
        for (var k = 0u; k < PRESSURE_CELLS; k++) {
            excess += excess_density(through(sample, outer ^ 1u, k));
        }
        let cells = f32(cells_to_sample(face.slope)) - 0.5 * f32(PRESSURE_CELLS - 1u);
        let height = cells * select(-1.0, 1.0, (outer & 1u) == 1u);
        excess = excess / f32(PRESSURE_CELLS) - 2.0 * height * at_rest[outer / 2u];
    } else {
        // In cells of a solid that moves there is noise: least squares of f = w (excess + c.slip), slip along the face.
        let mean = outward / all;
        let spread = mat3x3(columns[0] - outward.x * mean, columns[1] - outward.y * mean, columns[2] - outward.z * mean);
        excess = (sum - dot(outward, tangential_solution(spread, face.normal, leaving - sum * mean))) / all;
    }
    leaving -= excess * outward;
    let speed = length(face.u);
    let change = -(1.0 + 1.0 / kept) * leaving - face.area * face.friction * face.friction / max(speed, 1e-30) * face.u;
    let m = tangential_solution(weights, face.normal, change);
    // Limits the velocity m/6 to twice the velocity that the law has read.
    face.slip = share * min(1.0, 12.0 * speed / max(length(m), 1e-30)) * m;
    face.given = dot(outward, face.slip);
    // The leaks of a solid that moves have momentum along the face.
    let still = select(vec3(0.0), tangential_solution(weights, face.normal, outward), kept > LEAST_KEPT);
    let still_sum = all - dot(outward, still);
    let axes = tangents(face.normal);
    face.still = vec2(dot(axes[0], still), dot(axes[1], still));
    face.per_sum = select(0.0, 1.0 / still_sum, still_sum > LEAST_STILL * all);
    return face;
}

// Changes the populations that leave a full cell by its m; returns the momentum that the fluid gains.
fn exchange_at_slope(face: SlopingCell, cell: vec3<u32>, balance: f32) -> vec3<f32> {
    let around = neighbourhood(cell);
    let leak = balance * abs(face.given) * face.per_sum;
    let axes = tangents(face.normal);
    let along = face.slip + leak * (axes[0] * face.still.x + axes[1] * face.still.y);
    var gained = vec3(0.0);
    for (var q = 1u; q < 27u; q++) { // unroll
        if ((face.open & (1u << q)) != 0u) {
            let more = weight(q) * (dot(vec3<f32>(C[q]), along) - leak);
            let word = returned(around, face.slope, q);
            write_scalar(word.direction, word.scalar, read_scalar(word.direction, word.scalar) + more);
            gained += more * vec3<f32>(C[q]);
        }
    }
    return gained;
}

// Two unit vectors normal to n and to each other.
fn tangents(n: vec3<f32>) -> array<vec3<f32>, 2> {
    let other = select(vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), abs(n.x) > 0.6);
    let first = normalize(cross(n, other));
    return array(first, cross(n, first));
}

// The vector m normal to n for which the part of M m normal to n is that of b. M is singular where few directions are open; b is
// then in its range up to rounding.
fn tangential_solution(matrix: mat3x3<f32>, n: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    let axes = tangents(n);
    let first = axes[0];
    let second = axes[1];
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

// Cells whose mean density is the pressure: the one whose velocity the law reads, and those below it.
const PRESSURE_CELLS = 4u;

// Part of the deviation that a solid keeps below which it moves: at 0.2 % of the lattice speed.
const LEAST_KEPT = 0.998;

// Part of the weights of the open directions that must be without momentum along the face.
const LEAST_STILL = 0.5;

// Eigenvalues of M below this count as 0: the part of b there is rounding. One direction along the face has 1/216 or more.
const SMALLEST = 1e-5;
