// Partially saturated cells: the ten planes of values that blocks and fluid exchange, for each brick that blocks reach.
// needs $lanes

// Sum of the effective fractions of all parts, with a code: see encode_sum.
const PLANE_SUM = 0u;
// Mean velocity of the blocks (3).
const PLANE_VELOCITY = 1u;
// For the forces on the blocks: beta = B / sum, beta a and beta G (3). In cells without a block, of which solids at
// rest fill less than half, these are 1, rho - 1 and the velocity of the fluid.
const PLANE_BETA = 4u;
const PLANE_A = 5u;
const PLANE_G = 6u;
// Before a step with a wall model, the same planes hold the friction of blocks in the cells at their faces: the share of the
// law of the wall, and its stress over the density (3).
const PLANE_SHARE = PLANE_A;
const PLANE_STRESS = PLANE_G;
// Fraction that determines the weight of the solid, 0..1.
const PLANE_FRACTION = 9u;

// Added to the sum of a cell in the interior of a block.
const INTERIOR_SUM = 8.0;
// Added to the sum of a cell of a closing joint, in which several blocks meet.
const JOINT_SUM = 16.0;
// Replaces JOINT_SUM if the joint has two rows of cells: one block fills the cell, and the other block the next cell.
const FACING_SUM = 24.0;
// Replaces both if the blocks leave more of the cell empty.
const SHARED_SUM = 32.0;
// The sum of an empty cell next to a non-empty one.
const NEAR_SUM = -1.0;

struct SolidSum {
    // Sum over the blocks; more than 1 if they overlap.
    fraction: Real,
    // Next to a block, or in one.
    near: Mask,
    interior: Mask,
    joint: Mask,
    facing: Mask,
    // Whether several blocks meet in the cell.
    several: Mask,
}

fn encode_sum(fraction: Real, near: Mask, interior: Mask, joint: Mask, facing: Mask, several: Mask) -> Real {
    let open = select(Real(0.0), Real(SHARED_SUM), several);
    let closing = select(Real(JOINT_SUM), Real(FACING_SUM), facing);
    let code = select(select(open, closing, joint), Real(INTERIOR_SUM), interior);
    let empty = select(Real(0.0), Real(NEAR_SUM), near);
    return select(empty, fraction + code, fraction > Real(0.0));
}

fn decode_sum(kept: Real) -> SolidSum {
    let several = kept >= Real(JOINT_SUM);
    let open = kept >= Real(SHARED_SUM);
    let facing = (kept >= Real(FACING_SUM)) & !open;
    let interior = (kept >= Real(INTERIOR_SUM)) & !several;
    let met = select(select(Real(JOINT_SUM), Real(FACING_SUM), facing), Real(SHARED_SUM), open);
    let code = select(select(Real(0.0), Real(INTERIOR_SUM), interior), met, several);
    return SolidSum(max(kept - code, Real(0.0)), kept != Real(0.0), interior, several & !open, facing, several);
}
