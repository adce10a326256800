// Blocks in the lattice as partially saturated cells: data that the host passes to the device, in lattice units (a cell and
// a step are one).

// The section of a convex part of a block in one lane of a brick with blocks.
struct Tile {
    // Lowest cell of the tile, shifted by whole periods to be next to the part.
    cell: vec3<i32>,
    part: u32,
    block: u32,
    // Index of the brick among the bricks with blocks.
    slot: u32,
    lane: u32,
    // Packed range. Number of cells per axis, from the lowest, in the domain: x, y and z in 8 bits each, x lowest. Above them
    // the eighths of the cells, in workgroup order, that the part can reach: the first, and one past the last, in 4 bits each.
    inside: u32,
}

// Position of a convex part: its centroid is at base + fraction, so that cell - base is exact.
struct Part {
    base: vec3<i32>,
    first_face: u32,
    fraction: vec3<f32>,
    // Number of faces; 0 for a sphere of `radius`.
    faces: u32,
    // Bounding box from the centroid.
    low: vec3<f32>,
    radius: f32,
    high: vec3<f32>,
    block: u32,
}

// Motion of a block: the velocity at r from its centroid base + fraction is velocity + gradient_x r.x + gradient_y r.y +
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

// Mark in place of the solid fraction of a part in a cell: the cell and two layers of cells around it are inside the part.
const INTERIOR = 2.0;
// Mark of a cell that the part leaves empty, next to a cell that it does not.
const NEAR = -1.0;
// The same for a cell whose side lies on a face of the part.
const TOUCHES = -2.0;
// Mark of a cell that is left to voxelise_edges.
const UNDECIDED = 4.0;
// Numbers per block: force (3), moment (9), entrained fluid, displaced fluid, first moments of both (3 + 3).
const WRENCH = 20u;
// Numbers per layer of cells along a face: traction (3), moment (3), height, feet (3), products of feet (6), cells with fluid, cells.
const FACE_LOAD = 18u;

// Fractions of a part in a cell.
struct Fractions {
    // Volume of the part in the cell.
    solid: f32,
    // Effective fraction, which determines the weight of the solid: for the part alone, and if others fill the cell next to it.
    effective: vec2<f32>,
}

// The centre of a cell, from base + fraction.
fn centre_from(cell: vec3<i32>, base: vec3<i32>, fraction: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(cell - base) + 0.5 - fraction;
}

fn velocity_at(motion: Motion, r: vec3<f32>) -> vec3<f32> {
    return motion.velocity + motion.gradient_x * r.x + motion.gradient_y * r.y + motion.gradient_z * r.z;
}
