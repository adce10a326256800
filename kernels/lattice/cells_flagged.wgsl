// Cells beside others that are not fluid, and those.
// A byte a cell: bits 0-5 the neighbour at x-, x+, y-, y+, z-, z+ is not fluid; 6 beside a wall; 7 solid.
// needs $lanes, velocity, grid

@group(0) @binding(32) var<storage, read> flags: array<u32>;

fn cell_class(p: Place) -> u32 {
    return flags[p.element];
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
