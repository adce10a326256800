// Divergence guard: NaN, a density that is not positive, or a speed above MAX_SPEED, in the first step
// where it happens the cell of the lowest index. Bits are compared as integers, because a compiler
// may assume that there is no NaN: for a square they order as the numbers do, NaN above all.
// needs $lanes, velocity, grid, $cells

struct Guard {
    // Steps done after an even one, after an odd one: each is written only while the other is read.
    even: u32,
    odd: u32,
    first_step: atomic<u32>,
    first_cell: atomic<u32>,
}

@group(0) @binding(34) var<storage, read_write> guard_state: Guard;

override MAX_SPEED_SQUARED: f32;
// Parity of the step, and whether this dispatch is the one of its step that counts.
override GUARD_ODD: bool;
override GUARD_COUNTS: bool;

fn guard(p: Place, cell: u32, rho: Real, u: Vector) {
    let q = u.x * u.x + u.y * u.y + u.z * u.z;
    let bad = above(q, MAX_SPEED_SQUARED) | not_positive(rho);
    if (mask_any(bad)) {
        report(p, bad, solid(cell));
    }
    if (GUARD_COUNTS && p.element == 0u) {
        if (GUARD_ODD) {
            guard_state.odd = guard_state.even + 1u;
        } else {
            guard_state.even = guard_state.odd + 1u;
        }
    }
}

fn report(p: Place, bad: Mask, empty: Mask) {
    let step = select(guard_state.odd, guard_state.even, GUARD_ODD);
    for (var l = 0u; l < LANES; l++) {
        if (!mask_lane(bad, l) || mask_lane(empty, l) || atomicLoad(&guard_state.first_step) < step) {
            continue;
        }
        let z = p.coordinates.z + l * SLICES;
        atomicMin(&guard_state.first_step, step);
        atomicMin(&guard_state.first_cell, p.coordinates.x + NX * (p.coordinates.y + NY * z));
    }
}
