// The grid of elements: an element holds LANES_Y cells, NY apart in y, or LANES_Z, NZ apart in z; the grid is a torus.
// Non-periodic axes have at least one layer of cells that are not fluid after the last one.
// needs $lanes

override NX: u32;
override NY: u32;
override NZ: u32;
// Cells of an element along y and z: one of the two is LANES, the other 1.
override LANES_Y: u32;
override LANES_Z: u32;
override BRICK_X: u32;
override BRICK_Y: u32;
override BRICK_Z: u32;

// An element with its neighbours: index of (x + a, y + b, z + c) is x[1 + a] + y[1 + b] + z[1 + c].
struct Place {
    element: u32,
    x: vec3<u32>,
    y: vec3<u32>,
    z: vec3<u32>,
    coordinates: vec3<u32>,
    // First or last element along the axis of the lanes: the neighbour beyond it is in another lane.
    lowest: bool,
    highest: bool,
    outside: bool,
}

fn axis_neighbours(i: u32, n: u32, stride: u32) -> vec3<u32> {
    return stride * vec3(select(i - 1u, n - 1u, i == 0u), i, select(i + 1u, 0u, i + 1u == n));
}

fn place(brick: u32, local: u32) -> Place {
    let bricks_x = (NX + BRICK_X - 1u) / BRICK_X;
    let bricks_y = (NY + BRICK_Y - 1u) / BRICK_Y;
    let x = BRICK_X * (brick % bricks_x) + local % BRICK_X;
    let y = BRICK_Y * ((brick / bricks_x) % bricks_y) + (local / BRICK_X) % BRICK_Y;
    let z = BRICK_Z * (brick / (bricks_x * bricks_y)) + local / (BRICK_X * BRICK_Y);
    return place_at(vec3(x, y, z));
}

fn place_at(at: vec3<u32>) -> Place {
    var p: Place;
    p.x = axis_neighbours(at.x, NX, 1u);
    p.y = axis_neighbours(at.y, NY, NX);
    p.z = axis_neighbours(at.z, NZ, NX * NY);
    p.element = p.x.y + p.y.y + p.z.y;
    p.coordinates = at;
    p.lowest = select(at.z, at.y, LANES_Y > 1u) == 0u;
    p.highest = select(at.z + 1u == NZ, at.y + 1u == NY, LANES_Y > 1u);
    p.outside = at.x >= NX || at.y >= NY || at.z >= NZ;
    return p;
}

// The neighbour in direction c.
fn neighbour(p: Place, c: vec3<i32>) -> u32 {
    return p.x[1 + c.x] + p.y[1 + c.y] + p.z[1 + c.z];
}

// The component of a direction along the axis of the lanes.
fn along_lanes(c: vec3<i32>) -> i32 {
    return select(c.z, c.y, LANES_Y > 1u);
}

// A value read at the neighbour in direction c, shifted to the lanes of this element.
fn from_neighbour(p: Place, c: vec3<i32>, v: Real) -> Real {
    let step = along_lanes(c);
    if (step == 1) {
        return select(v, rotate_up(v), p.highest);
    }
    if (step == -1) {
        return select(v, rotate_down(v), p.lowest);
    }
    return v;
}

// A value to be written at the neighbour in direction c, shifted to the lanes of the neighbour.
fn to_neighbour(p: Place, c: vec3<i32>, v: Real) -> Real {
    let step = along_lanes(c);
    if (step == 1) {
        return select(v, rotate_down(v), p.highest);
    }
    if (step == -1) {
        return select(v, rotate_up(v), p.lowest);
    }
    return v;
}

// Index of the cell of a lane in the padded grid, x fastest.
fn padded_index(p: Place, lane: u32) -> u32 {
    let y = p.coordinates.y + NY * (lane % LANES_Y);
    let z = p.coordinates.z + NZ * (lane / LANES_Y);
    return p.coordinates.x + NX * (y + NY * LANES_Y * z);
}
