// Particles in a grid of cells half as wide as the support of the kernel function: the neighbours of a particle are at
// most two cells away. Lengths are in particle spacings, times in spacings over the speed of sound, masses in particle
// masses. Positions are whole numbers of quanta from the lower corner of the grid, so that differences are exact
// everywhere, and the cell of a position follows from one division.

struct Particle {
    // Quanta; the first component is negative if the particle has left the domain.
    at: vec3<i32>,
    // Identity of a fluid particle; index of a boundary particle.
    id: u32,
    velocity: vec3<f32>,
    // Density over reference density, less one; pressure of a boundary particle.
    excess: f32,
}

// Edges of a cell, quanta.
override EDGE_X: i32;
override EDGE_Y: i32;
override EDGE_Z: i32;
override CELLS_X: i32;
override CELLS_Y: i32;
override CELLS_Z: i32;
// Spacings per quantum.
override QUANTUM: f32;
// Square of the support of the kernel function.
override SUPPORT_SQUARED: f32;

fn cell_of(at: vec3<i32>) -> vec3<i32> {
    return at / vec3(EDGE_X, EDGE_Y, EDGE_Z);
}

// Escaped particles are in a cell after all others.
fn cell_number(at: vec3<i32>) -> u32 {
    if (at.x < 0) {
        return u32(CELLS_X * CELLS_Y * CELLS_Z);
    }
    let cell = cell_of(at);
    return u32((cell.z * CELLS_Y + cell.y) * CELLS_X + cell.x);
}
