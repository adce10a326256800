// Asmuth et al. 2021, Phys. Fluids 33:105111, for faces of blocks at an angle to the grid. The full cells at such a face have
// reflected the populations that arrived. Those that now leave to the fluid get w c.m more, m along the face: the tangential momentum
// that arrived leaves again, less the stress of the law of the wall times the area of the face in the column of the cell. The
// surface of the full cells is a staircase; with m, the velocity of the solid along the face crosses its steps.
// needs sloping_faces, near_wall_bits, mixing_length, incoming, weights

// The cells of outer_cells.
@group(0) @binding(49) var<storage, read_write> slopes: array<SlopingCell>;

// Runs after find_faces, at cells without a grid-aligned face.
@compute @workgroup_size(64)
fn find_slopes(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let count = atomicLoad(&outer_cells.count);
    for (var n = invocation(group, groups, local); n < count; n += 64u * groups.x * groups.y) {
        let here = outer_cell(n);
        slopes[n].slope = NO_SLOPE;
        if (atomicLoad(&face_codes[here.number]) == 0u) {
            let face = sloping_face(here.cell, here.solid);
            slopes[n] = face;
            if (face.slope != NO_SLOPE) {
                let code = select(SLIDES, FULL_AT_SLOPE, here.solid.fraction >= FULL);
                atomicStore(&face_codes[here.number], bitcast<u32>(f32(code)));
            }
        }
    }
}

// Applies the law at these faces, for the next step: data for the cells that they cut, and the eddy viscosity of the fluid above.
@compute @workgroup_size(64)
fn slope_law(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let count = atomicLoad(&outer_cells.count);
    for (var n = invocation(group, groups, local); n < count; n += 64u * groups.x * groups.y) {
        if (slopes[n].slope != NO_SLOPE) {
            apply_at_slope(n, outer_cell(n));
        }
    }
}

fn apply_at_slope(n: u32, here: OuterCell) {
    let law = law_at_slope(slopes[n], velocity_of_block(here.solid));
    slopes[n].u = law.u;
    slopes[n].friction = law.friction;
    let share = model_share(law.friction);
    write_psm(PLANE_SHARE, here.solid.slot, here.solid.place, share);
    if (here.solid.fraction < FULL) {
        for (var a = 0u; a < 3u; a++) { // unroll
            write_psm(PLANE_STRESS + a, here.solid.slot, here.solid.place, law.normal[a]);
        }
    }
    set_viscosity_above(law, here.cell, law.friction * share);
}

// Runs at the end of the step, as clear_viscosity does.
@compute @workgroup_size(64)
fn clear_above_slopes(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let count = atomicLoad(&outer_cells.count);
    for (var n = invocation(group, groups, local); n < count; n += 64u * groups.x * groups.y) {
        if (slopes[n].slope != NO_SLOPE) {
            set_viscosity_above(slopes[n], outer_cell(n).cell, 0.0);
        }
    }
}

// Sets the eddy viscosity of the fluid above the uppermost full cell of a column: that of the mixing length, or 0.
fn set_viscosity_above(face: SlopingCell, cell: vec3<u32>, friction: f32) {
    if ((face.slope & SLOPE_TOP) == 0u) {
        return;
    }
    let nearest = face.slope & 7u;
    let cells = face.slope >> SLOPE_CELLS;
    let rise = abs(face.normal[nearest / 2u]);
    var at = cell;
    for (var k = 1u; k <= cells; k++) {
        at = through(at, nearest, 1u);
        let y = face.distance - f32(cells - k) * rise;
        if (friction == 0.0) {
            atomicStore(&near_wall_viscosity[scalar_of(at)], 0u);
        } else if (y > 1.0 || (y > 0.0 && fraction_at(at) == 0.0)) {
            atomicMax(&near_wall_viscosity[scalar_of(at)], bitcast<u32>(KARMAN * y * taper(y) * friction));
        }
    }
}

// Runs after the collision of the bricks that blocks reach; its parity is that of the next step.
@compute @workgroup_size(64)
fn sloping_friction(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let count = atomicLoad(&outer_cells.count);
    for (var n = invocation(group, groups, local); n < count; n += 64u * groups.x * groups.y) {
        if (slopes[n].slope == NO_SLOPE || slopes[n].open == 0u) {
            continue;
        }
        let share = model_share(slopes[n].friction);
        if (share > 0.0) {
            apply_sloping_friction(slopes[n], outer_cell(n), share);
        }
    }
}

fn apply_sloping_friction(face: SlopingCell, here: OuterCell, share: f32) {
    let around = neighbourhood(here.cell);
    // Momentum of the populations that leave to the fluid, and the sum of w c c.
    var leaving = vec3(0.0);
    var columns: array<vec3<f32>, 3>;
    for (var q = 1u; q < 27u; q++) { // unroll
        if ((face.open & (1u << q)) != 0u) {
            let c = vec3<f32>(C[q]);
            leaving += read_outgoing(around, q) * c;
            columns[0] += (weight(q) * f32(C[q].x)) * c;
            columns[1] += (weight(q) * f32(C[q].y)) * c;
            columns[2] += (weight(q) * f32(C[q].z)) * c;
        }
    }
    let weights = mat3x3(columns[0], columns[1], columns[2]);
    // Relative to the block.
    leaving -= 3.0 * (weights * velocity_of_block(here.solid));
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
            write_outgoing(around, q, read_outgoing(around, q) + more);
            gained += more * vec3<f32>(C[q]);
        }
    }
    // The block loses what the fluid gains.
    let parts = decode_sum(read_psm(PLANE_SUM, here.solid.slot, here.solid.place)).fraction;
    for (var a = 0u; a < 3u; a++) { // unroll
        let before = read_psm(PLANE_G + a, here.solid.slot, here.solid.place);
        write_psm(PLANE_G + a, here.solid.slot, here.solid.place, before + gained[a] / parts);
    }
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
