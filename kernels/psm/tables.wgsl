// Blocks in the lattice as partially saturated cells: what the host passes to the device. Lattice units: a cell and a
// step are one.

// The part of one convex part of a block in one lane of one brick with blocks.
struct Tile {
    // Its lowest cell, shifted by whole periods to be next to the part.
    cell: vec3<i32>,
    part: u32,
    block: u32,
    // Number of the brick among the bricks with blocks.
    slot: u32,
    lane: u32,
    // Cells an axis, from the lowest, that lie in the domain: x, y and z in 8 bits each, x lowest. Above them the eighths
    // of its cells, in the order of the workgroup, that the part can reach: the first, and one past the last, in 4 bits.
    inside: u32,
}

// Where a convex part is: its centroid is at base + fraction, so that cell - base is exact.
struct Part {
    base: vec3<i32>,
    first_face: u32,
    fraction: vec3<f32>,
    // None: a sphere of `radius`.
    faces: u32,
    // Its bounding box, from the centroid.
    low: vec3<f32>,
    radius: f32,
    high: vec3<f32>,
    block: u32,
}

// How a block moves: at r from its centroid base + fraction with velocity + gradient_x r.x + gradient_y r.y +
// gradient_z r.z.
struct Motion {
    base: vec3<i32>,
    pad0: u32,
    fraction: vec3<f32>,
    pad1: u32,
    velocity: vec3<f32>,
    pad2: u32,
    gradient_x: vec3<f32>,
    pad3: u32,
    gradient_y: vec3<f32>,
    pad4: u32,
    gradient_z: vec3<f32>,
    pad5: u32,
}

// Solid fraction of a part in a cell that is inside it with two layers of cells around.
const INTERIOR = 2.0;
// Solid fraction of a part in a cell that it leaves empty, next to a cell that it does not.
const NEAR = -1.0;
// The same of a cell whose side lies on a face of the part.
const TOUCHES = -2.0;
// Solid fraction of a cell that is left to voxelise_edges.
const UNDECIDED = 4.0;
// Numbers that a block has: force (3), moment (9), entrained fluid, displaced fluid, first moments of both (3 + 3).
const WRENCH = 20u;
// Numbers that a face has: traction (3), moment (3), height, feet (3), products of feet (6), cells with fluid, cells.
const FACE_LOAD = 18u;

// Of a part in a cell.
struct Fractions {
    // Its volume there.
    solid: f32,
    // What decides the weight of the solid: where the part is alone, and where others fill the cell beside it.
    effective: vec2<f32>,
}

// The centre of a cell, from base + fraction.
fn centre_from(cell: vec3<i32>, base: vec3<i32>, fraction: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(cell - base) + 0.5 - fraction;
}

fn velocity_at(motion: Motion, r: vec3<f32>) -> vec3<f32> {
    return motion.velocity + motion.gradient_x * r.x + motion.gradient_y * r.y + motion.gradient_z * r.z;
}
