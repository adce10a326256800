// Particles in a grid of cells half as wide as the support of the kernel function: those that a particle feels are in
// its cell and two around it. Lengths are in particle spacings, times in those that sound takes for one, masses in those of a particle. Positions are whole numbers of quanta from
// the lower corner of the grid: their differences are exact anywhere, and a cell is one division away.

struct Particle {
    // Quanta; the first negative: it has left.
    at: vec3<i32>,
    // What it is called, or the number of a particle of a shell.
    id: u32,
    velocity: vec3<f32>,
    // Density less the reference density, in parts of it; of a particle of a shell its pressure.
    excess: f32,
}

// Edges of a cell, quanta.
override EDGE_X: i32 = 1;
override EDGE_Y: i32 = 1;
override EDGE_Z: i32 = 1;
override CELLS_X: i32 = 1;
override CELLS_Y: i32 = 1;
override CELLS_Z: i32 = 1;
// Spacings a quantum.
override QUANTUM: f32 = 1.0;
// Square of the support of the kernel function.
override SUPPORT_SQUARED: f32 = 16.0;

fn cell_of(at: vec3<i32>) -> vec3<i32> {
    return at / vec3(EDGE_X, EDGE_Y, EDGE_Z);
}

// Those that have left are in a cell after all others.
fn cell_number(at: vec3<i32>) -> u32 {
    if (at.x < 0) {
        return u32(CELLS_X * CELLS_Y * CELLS_Z);
    }
    let cell = cell_of(at);
    return u32((cell.z * CELLS_Y + cell.y) * CELLS_X + cell.x);
}
