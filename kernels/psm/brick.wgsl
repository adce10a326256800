// Bricks of elements, and lists of jobs for their workgroups.
// needs workgroup_index, workgroup

override BRICK_X: u32;
override BRICK_Y: u32;

// An unused entry of a list of jobs.
const NOTHING = 0xffffffffu;
// Flag of a job: all of its elements are processed, not only those that parts can reach.
const WHOLE = 0x80000000u;

// Position of an invocation's element in the brick.
fn place_in_brick(local: u32) -> vec3<u32> {
    return vec3(local % BRICK_X, (local / BRICK_X) % BRICK_Y, local / (BRICK_X * BRICK_Y));
}

// Whether the element at `place` is a cell of the domain, in a tile with the packed range `inside`.
fn in_domain(place: vec3<u32>, inside: u32) -> bool {
    return all(place < ((vec3(inside) >> vec3(0u, 8u, 16u)) & vec3(255u)));
}

// The first element that the part can reach in a tile with the packed range `inside`, and one past the last.
fn reach_of(inside: u32) -> vec2<u32> {
    return min(vec2((inside >> 24u) & 15u, inside >> 28u) * ((WORKGROUP + 7u) / 8u), vec2(WORKGROUP));
}
