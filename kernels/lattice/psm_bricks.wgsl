// Gardner & Sitar 2018, section 3.4: the cells of the bricks that blocks reach, one by one.
// needs scalar_grid

// Number of bricks that blocks reach, followed by these bricks.
@group(0) @binding(40) var<storage, read> bricks: array<u32>;

// One invocation per cell of the bricks that blocks reach: adjacent invocations have adjacent cells and mostly the same branches.
struct PsmPlace {
    slot: u32,
    element: u32,
    lane: u32,
}

fn psm_invocation(index: u32) -> PsmPlace {
    let elements = BRICK_X * BRICK_Y * BRICK_Z;
    return PsmPlace(
        index / (LANES_OF_ELEMENT * elements),
        index % elements,
        (index / elements) % LANES_OF_ELEMENT,
    );
}

// The cell of a slot that has a brick.
fn cell_at(at: PsmPlace) -> vec3<u32> {
    return cell_in(bricks[1u + at.slot], at.element, at.lane);
}

// The cell of an element of a brick in one lane; beyond the domain if the cell belongs to the next lane.
fn cell_in(brick: u32, element: u32, lane: u32) -> vec3<u32> {
    let bricks_x = (NX + BRICK_X - 1u) / BRICK_X;
    let bricks_y = (NY + BRICK_Y - 1u) / BRICK_Y;
    let x = BRICK_X * (brick % bricks_x) + element % BRICK_X;
    let y = BRICK_Y * ((brick / bricks_x) % bricks_y) + (element / BRICK_X) % BRICK_Y;
    let z = BRICK_Z * (brick / (bricks_x * bricks_y)) + element / (BRICK_X * BRICK_Y);
    let cell = vec3(x, y + NY * (lane % LANES_Y), z + NZ * (lane / LANES_Y));
    return select(vec3(CELLS_X, CELLS_Y, CELLS_Z), cell, y < NY && z < NZ);
}
