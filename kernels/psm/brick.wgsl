// Bricks of elements, and lists of jobs for their workgroups.
// needs workgroup_index, workgroup

override BRICK_X: u32;
override BRICK_Y: u32;

// A place in a list of jobs that is not used.
const NOTHING = 0xffffffffu;
// Added to a job: all of its elements are to be done, not only those that parts can reach.
const WHOLE = 0x80000000u;

// Where an invocation's element lies in the brick.
fn place_in_brick(local: u32) -> vec3<u32> {
    return vec3(local % BRICK_X, (local / BRICK_X) % BRICK_Y, local / (BRICK_X * BRICK_Y));
}

// Whether that is a cell of the domain, in the tile whose packed number of cells is `inside`.
fn in_domain(place: vec3<u32>, inside: u32) -> bool {
    return all(place < ((vec3(inside) >> vec3(0u, 8u, 16u)) & vec3(255u)));
}

// The first element that a part can reach in a tile with that number, and one past the last.
fn reach_of(inside: u32) -> vec2<u32> {
    return min(vec2((inside >> 24u) & 15u, inside >> 28u) * ((WORKGROUP + 7u) / 8u), vec2(WORKGROUP));
}
