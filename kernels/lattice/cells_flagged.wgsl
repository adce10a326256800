// Ginzburg & d'Humieres 2003, Phys. Rev. E 68:066614: beside walls the odd moments relax at the rate
// that puts half-way bounce-back exactly half a cell away, (1/s - 1/2)(tau - 1/2) = 3/16, floored.
// A byte a cell: bits 0-5 the neighbour at x-, x+, y-, y+, z-, z+ is not fluid; 6 beside a wall; 7 solid.
// needs $lanes, velocity, grid

@group(0) @binding(32) var<storage, read> flags: array<u32>;

override S10: f32;
override S13: f32;
override S23: f32;
override S26: f32;
override W10: f32;
override W13: f32;
override W23: f32;
override W26: f32;

struct OddRates {
    s10: Real,
    s13: Real,
    s23: Real,
    s26: Real,
}

fn cell_class(p: Place) -> u32 {
    return flags[p.element];
}

fn odd_rates(cell: u32) -> OddRates {
    let wall = flag(cell, 6u);
    return OddRates(
        select(Real(S10), Real(W10), wall),
        select(Real(S13), Real(W13), wall),
        select(Real(S23), Real(W23), wall),
        select(Real(S26), Real(W26), wall),
    );
}

fn solid(cell: u32) -> Mask {
    return flag(cell, 7u);
}

// Cells that are not fluid hold the state of rest.
fn clear_solid(cell: u32, f: ptr<function, array<Real, 27>>) {
    let empty = solid(cell);
    for (var k = 0u; k < 27u; k++) { // unroll
        (*f)[k] = select((*f)[k], Real(0.0), empty);
    }
}

fn still_in_solid(cell: u32, u: Vector) -> Vector {
    let empty = solid(cell);
    let zero = Real(0.0);
    return Vector(select(u.x, zero, empty), select(u.y, zero, empty), select(u.z, zero, empty));
}

// Derivative along an axis from the values below, here and above; one-sided where a neighbour is
// not fluid, 0 where neither is. `face` is 0, 2 or 4 for x, y, z.
fn difference(cell: u32, face: u32, below: Real, here: Real, above: Real) -> Real {
    let no_below = flag(cell, face);
    let no_above = flag(cell, face + 1u);
    let low = select(below, here, no_below);
    let high = select(above, here, no_above);
    return (high - low) * select(Real(0.5), Real(1.0), no_below | no_above);
}
