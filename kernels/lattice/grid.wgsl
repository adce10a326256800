// The grid of elements: an element holds LANES cells, SLICES apart in z; the grid is a torus.
// Non-periodic axes carry at least one layer of cells that are not fluid behind the last one.
// needs $lanes

override NX: u32;
override NY: u32;
override SLICES: u32;
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
    // In the lowest slice, in the highest slice: the neighbour is in another lane.
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
    p.z = axis_neighbours(at.z, SLICES, NX * NY);
    p.element = p.x.y + p.y.y + p.z.y;
    p.coordinates = at;
    p.lowest = at.z == 0u;
    p.highest = at.z + 1u == SLICES;
    p.outside = at.x >= NX || at.y >= NY || at.z >= SLICES;
    return p;
}

// The neighbour in direction c.
fn neighbour(p: Place, c: vec3<i32>) -> u32 {
    return p.x[1 + c.x] + p.y[1 + c.y] + p.z[1 + c.z];
}

// What was read at the neighbour in direction c, in the lanes of this element.
fn from_neighbour(p: Place, c: vec3<i32>, v: Real) -> Real {
    if (c.z == 1) {
        return select(v, rotate_up(v), p.highest);
    }
    if (c.z == -1) {
        return select(v, rotate_down(v), p.lowest);
    }
    return v;
}

// What is to be written at the neighbour in direction c, in the lanes of that one.
fn to_neighbour(p: Place, c: vec3<i32>, v: Real) -> Real {
    if (c.z == 1) {
        return select(v, rotate_down(v), p.highest);
    }
    if (c.z == -1) {
        return select(v, rotate_up(v), p.lowest);
    }
    return v;
}
