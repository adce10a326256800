// Asmuth et al. 2021, Phys. Fluids 33:105111: the law of the wall at a face of a solid at an angle to the grid.
// needs cell_velocities, law_of_the_wall, scalar_grid

// A cell at such a face.
struct SlopingCell {
    // The face x-, x+, ... nearest to the sloping one, SLOPE_TOP if the cell is the uppermost full one of its column, in four bits
    // from SLOPE_CELLS on the number of cells to the one whose velocity the law reads, and from SLOPE_FREE_SLIP on a bit for each face
    // x-, x+, ... of the cell that is a free-slip face of the domain; or NO_SLOPE.
    slope: u32,
    // Directions from a full cell to cells that are not full, one bit each; 0 in other cells.
    open: u32,
    // Scalar of the cell whose velocity the law reads, and its distance from the face, cells.
    sample: u32,
    distance: f32,
    normal: vec3<f32>,
    // Friction velocity, and the tangential velocity that the law has read, relative to the solid.
    friction: f32,
    u: vec3<f32>,
    // Of a face of a block: its entry in outer_cells.
    outer: u32,
    // The m of sloping_exchange.wgsl, times the share of the law, and the sum that the populations get by it.
    slip: vec3<f32>,
    given: f32,
    // Area of the face that acts on the cell, in faces of a cell; 0 below the top of a column.
    area: f32,
    // Without momentum along the face the cell gives off w (1 - c.still), in the axes of tangents(normal): the inverse of its sum, 0
    // where all directions have such momentum.
    per_sum: f32,
    still: vec2<f32>,
}

const NO_SLOPE = 0xffffu;
const SLOPE_TOP = 8u;
const SLOPE_CELLS = 4u;
const SLOPE_FREE_SLIP = 8u;

fn cells_to_sample(slope: u32) -> u32 {
    return (slope >> SLOPE_CELLS) & 15u;
}

// Result of the law at such a face of a solid with this velocity.
fn law_at_slope(face: SlopingCell, velocity: vec3<f32>, roughness: f32) -> SlopingCell {
    var found = face;
    let u = vec3(read_velocity(0u, face.sample), read_velocity(1u, face.sample), read_velocity(2u, face.sample)) - velocity;
    found.u = u - dot(u, face.normal) * face.normal;
    found.friction = sqrt(law_of_the_wall(length(found.u), face.distance, roughness));
    return found;
}
