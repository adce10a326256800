// Gardner & Sitar 2018, eq. 8: f* = f + (1 - B) fluid + B solid, with a B of its own for the momentum, and its least values.
// needs joint_gap, $lanes

// As a joint opens, its cells become ordinary ones. While both faces are in one cell, and in nearly full cells, B is at least this
// value, since the weight of a cell without friction is zero.
const LEAST_WEIGHT = 0.25;
// The same for all other moments. Full cells reflect the populations that leave a joint, after two steps, and the loads reach
// blocks late: without damping here, oscillations with a period of four steps grow between blocks of few cells.
const JOINT_DAMPING = 0.0625;

// Weights that blend the change of a moment with the change by the solid: of momentum, and of higher moments.
struct SolidWeights {
    momentum: Real,
    higher: Real,
}

// How closely a cell that a solid fills by the fraction e is closed: 0 up to OPEN_GAP from full, 1 from CLOSED_GAP on.
fn closure_of(e: Real) -> Real {
    return clamp((e - Real(1.0 - OPEN_GAP)) / (OPEN_GAP - CLOSED_GAP), Real(0.0), Real(1.0));
}

// Blends the change by the collision with the change by the solid.
fn blend_with_solid(weights: SolidWeights, solid: ptr<function, array<Real, 27>>, change: ptr<function, array<Real, 27>>) {
    for (var k = 1u; k < 27u; k++) { // unroll
        let part = select(weights.higher, weights.momentum, Mask(k == 1u || k == 3u || k == 9u));
        (*change)[k] += part * ((*solid)[k] - (*change)[k]);
    }
}
