// Flags of cells that are not fluid, and of their neighbours.
// One byte per cell: bits 0-5 the neighbour at x-, x+, y-, y+, z-, z+ is not fluid; 6 next to a wall; 7 solid.
// needs $lanes, velocity, grid

@group(0) @binding(32) var<storage, read> flags: array<u32>;

override CELLS_X: u32;
override CELLS_Y: u32;
override CELLS_Z: u32;
// Faces of the domain that are neither walls at rest nor periodic: one bit each, x-, x+, y-, y+, z-, z+.
override NO_WALLS: u32;

fn cell_class(p: Place) -> u32 {
    return flags[p.element];
}

fn solid(cell: u32) -> Mask {
    return flag(cell, 7u);
}

fn next_to_wall(cell: u32) -> Mask {
    return flag(cell, 6u);
}

// Whether a wall at rest or a solid is next to a cell: face 0 to 5 is x-, x+, y-, y+, z-, z+.
fn wall_at(p: Place, cell: u32, face: u32) -> Mask {
    let at = p.coordinates;
    var end: Mask;
    switch face {
        case 0u: { end = Mask(at.x == 0u); }
        case 1u: { end = Mask(at.x + 1u == CELLS_X); }
        case 2u: { end = in_layer(at.y, NY, LANES_Y, 0u); }
        case 3u: { end = in_layer(at.y, NY, LANES_Y, CELLS_Y - 1u); }
        case 4u: { end = in_layer(at.z, NZ, LANES_Z, 0u); }
        default: { end = in_layer(at.z, NZ, LANES_Z, CELLS_Z - 1u); }
    }
    let open = Mask((NO_WALLS & (1u << face)) != 0u);
    return flag(cell, face) & !(open & end);
}

// Whether the cells of element i of n are in the layer `layer`, along an axis with `lanes` cells per element.
fn in_layer(i: u32, n: u32, lanes: u32, layer: u32) -> Mask {
    if (lanes > 1u) {
        return in_slice(i, n, layer);
    }
    return Mask(i == layer);
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
