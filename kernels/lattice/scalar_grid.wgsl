// Access to single cells, for kernels that run on surfaces, at the start, or for output.
// needs lattice

override NX: u32;
override NY: u32;
override NZ: u32;
// Cells of an element: see grid.wgsl.
override LANES_Y: u32;
override LANES_Z: u32;
override LANES_OF_ELEMENT: u32;
override CELLS_X: u32;
override CELLS_Y: u32;
override CELLS_Z: u32;
// Elements of a brick.
override BRICK_X: u32;
override BRICK_Y: u32;
override BRICK_Z: u32;

// Parameters in which the dispatches of one kernel differ.
struct CellPass {
    // Parity of the step that loads.
    odd: u32,
    // Half of the words that is written where two cells share a word.
    half: u32,
    // Range of the kernel's list of cells that is processed.
    first: u32,
    end: u32,
}

@group(0) @binding(45) var<uniform> cell_pass: CellPass;

// Index of an invocation, for workgroups of 64 that are dispatched over two dimensions.
fn invocation(group: vec3<u32>, groups: vec3<u32>, local: u32) -> u32 {
    return (group.x + group.y * groups.x) * 64u + local;
}

// Cell n of the domain, x fastest.
fn domain_cell(n: u32) -> vec3<u32> {
    return vec3(n % CELLS_X, (n / CELLS_X) % CELLS_Y, n / (CELLS_X * CELLS_Y));
}

// Cell n of the padded grid, x fastest.
fn padded_cell(n: u32) -> vec3<u32> {
    let y = NY * LANES_Y;
    return vec3(n % NX, (n / NX) % y, n / (NX * y));
}

// The element of a padded cell, and its lane there.
fn element_and_lane(cell: vec3<u32>) -> vec2<u32> {
    let element = cell.x + NX * (cell.y % NY + NY * (cell.z % NZ));
    return vec2(element, cell.y / NY + cell.z / NZ);
}

// Index of a padded cell among the scalars of a direction.
fn scalar_of(cell: vec3<u32>) -> u32 {
    let at = element_and_lane(cell);
    return at.x * LANES_OF_ELEMENT + at.y;
}

// The padded cell of a scalar.
fn cell_of_scalar(n: u32) -> vec3<u32> {
    let element = n / LANES_OF_ELEMENT;
    let lane = n % LANES_OF_ELEMENT;
    let y = (element / NX) % NY + NY * (lane % LANES_Y);
    let z = element / (NX * NY) + NZ * (lane / LANES_Y);
    return vec3(element % NX, y, z);
}

// The cell at distance `n` through a face, also across a periodic face.
fn through(cell: vec3<u32>, face: u32, n: u32) -> vec3<u32> {
    let size = vec3(CELLS_X, CELLS_Y, CELLS_Z);
    let axis = face / 2u;
    var other = cell;
    other[axis] = (cell[axis] + select(size[axis] - n, n, face % 2u == 1u)) % size[axis];
    return other;
}

fn opposite(q: u32) -> u32 {
    return select(((q - 1u) ^ 1u) + 1u, 0u, q == 0u);
}
