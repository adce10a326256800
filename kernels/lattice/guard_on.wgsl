// Divergence guard: detects NaN, a density that is not positive, or a speed above MAX_SPEED, and keeps the
// cell of the lowest index in the first step with a fault. Bits are compared as integers, because a compiler
// may assume that there is no NaN: the bits of a square have the order of its values, with NaN above all.
// A CPU adapter executes both sides of every branch, so the code that runs only once is kept short.
// needs $lanes, velocity, grid, $cell_flags

struct Guard {
    // Number of steps done, after an even step and after an odd step: each is written only while the other is read.
    // The step after the first fault marks the count as STOPPED and keeps it.
    even: u32,
    odd: u32,
    // Lowest cell at fault in the even steps and in the odd steps, until the count stops.
    even_cell: atomic<u32>,
    odd_cell: atomic<u32>,
}

@group(0) @binding(34) var<storage, read_write> guard_state: Guard;

override MAX_SPEED_SQUARED: f32;
// Parity of the step, and whether this dispatch counts the step.
override GUARD_ODD: bool;
override GUARD_COUNTS: bool;

const NO_CELL = 0xffffffffu;
const STOPPED = 0x80000000u;

fn out_of_range(cell: u32, rho: Real, u: Vector) -> Mask {
    let q = u.x * u.x + u.y * u.y + u.z * u.z;
    return (above(q, MAX_SPEED_SQUARED) | not_positive(rho)) & !solid(cell);
}

// Records the cells at fault; one invocation per step counts the step.
fn guard(p: Place, bad: Mask, first: bool) {
    if (mask_any(bad)) {
        if (steps_done() < STOPPED) {
            let cell = padded_index(p, lowest_lane(bad));
            if (GUARD_ODD) {
                atomicMin(&guard_state.odd_cell, cell);
            } else {
                atomicMin(&guard_state.even_cell, cell);
            }
        }
    }
    if (GUARD_COUNTS && first) {
        let done = steps_done();
        if (GUARD_ODD) {
            guard_state.odd = count(done, atomicLoad(&guard_state.even_cell));
        } else {
            guard_state.even = count(done, atomicLoad(&guard_state.odd_cell));
        }
    }
}

// Steps before this one. Loaded only where it is needed: a GPU would wait for it in every invocation.
fn steps_done() -> u32 {
    return select(guard_state.odd, guard_state.even, GUARD_ODD);
}

fn count(done: u32, cell_before: u32) -> u32 {
    return select(done + 1u, done | STOPPED, cell_before != NO_CELL || done >= STOPPED);
}
