// Ladd 1994, J. Fluid Mech. 271:285: the cells at moving walls and velocity inlets.

// A padded cell and the directions that lead through a moving face normal to x, y, z.
struct MovingCell {
    cell: u32,
    through_x: u32,
    through_y: u32,
    through_z: u32,
}

@group(0) @binding(40) var<storage, read> moving_cells: array<MovingCell>;
