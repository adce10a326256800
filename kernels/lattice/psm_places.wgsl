// Gardner & Sitar 2018, section 3.4: location of the planes of a cell that blocks may reach.
// needs scalar_grid

// Slot of each brick among those that blocks reach, from 1; 0 for the others.
@group(0) @binding(41) var<storage, read> psm_slots: array<u32>;

// The slot of the brick of a cell, from 1, and the place of the cell in it; 0 where no block reaches the brick.
fn psm_place(cell: vec3<u32>) -> vec2<u32> {
    let size = vec3(BRICK_X, BRICK_Y, BRICK_Z);
    let lane = cell.y / NY + cell.z / NZ;
    let at = vec3(cell.x, cell.y % NY, cell.z % NZ);
    let brick = at / size;
    let bricks_x = (NX + BRICK_X - 1u) / BRICK_X;
    let bricks_y = (NY + BRICK_Y - 1u) / BRICK_Y;
    let slot = psm_slots[brick.x + bricks_x * (brick.y + bricks_y * brick.z)];
    let inner = at % size;
    let element = inner.x + BRICK_X * (inner.y + BRICK_Y * inner.z);
    return vec2(slot, element * LANES_OF_ELEMENT + lane);
}
