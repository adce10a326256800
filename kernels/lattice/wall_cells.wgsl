// Asmuth et al. 2021, Phys. Fluids 33:105111: the cells next to a wall whose friction follows from a law of the wall, and the
// column of cells above each.
// needs scalar_grid

struct WallCell {
    // Index in the padded grid.
    cell: u32,
    // The face of the cell that is the wall: x-, x+, y-, y+, z-, z+.
    face: u32,
    // Number of cells from the wall whose eddy viscosity follows from the law.
    layers: u32,
    // Equivalent sand roughness, cells; 0 for a smooth wall.
    roughness: f32,
}

@group(0) @binding(40) var<storage, read> wall_cells: array<WallCell>;

// The cell of a layer above the wall, counted from 0.
fn layer_cell(here: WallCell, layer: u32) -> vec3<u32> {
    let size = vec3(NX, NY * LANES_Y, NZ * LANES_Z);
    var at = padded_cell(here.cell);
    let axis = here.face / 2u;
    // Also across a periodic face.
    let step = select(layer, size[axis] - layer, here.face % 2u == 1u);
    at[axis] = (at[axis] + step) % size[axis];
    return at;
}
