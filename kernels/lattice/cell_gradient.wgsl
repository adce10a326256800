// Central differences of a velocity field on the domain cells; one-sided next to cells that are not fluid.
// needs scalar_grid, $neighbour_flags, wale

@group(0) @binding(51) var<storage, read> velocity_x: array<f32>;
@group(0) @binding(52) var<storage, read> velocity_y: array<f32>;
@group(0) @binding(53) var<storage, read> velocity_z: array<f32>;

fn cell_velocity(cell: vec3<u32>) -> vec3<f32> {
    let n = cell.x + CELLS_X * (cell.y + CELLS_Y * cell.z);
    return vec3(velocity_x[n], velocity_y[n], velocity_z[n]);
}

fn slope(cell: vec3<u32>, cell_flags: u32, axis: u32) -> vec3<f32> {
    let n = vec3(CELLS_X, CELLS_Y, CELLS_Z);
    let no_below = (cell_flags & (1u << (2u * axis))) != 0u;
    let no_above = (cell_flags & (2u << (2u * axis))) != 0u;
    var below = cell;
    var above = cell;
    if (!no_below) {
        below[axis] = (cell[axis] + n[axis] - 1u) % n[axis];
    }
    if (!no_above) {
        above[axis] = (cell[axis] + 1u) % n[axis];
    }
    let weight = select(0.5, 1.0, no_below || no_above);
    return weight * (cell_velocity(above) - cell_velocity(below));
}

fn cell_gradient(cell: vec3<u32>, cell_flags: u32) -> Gradient {
    let x = slope(cell, cell_flags, 0u);
    let y = slope(cell, cell_flags, 1u);
    let z = slope(cell, cell_flags, 2u);
    return Gradient(Vector(x.x, y.x, z.x), Vector(x.y, y.y, z.y), Vector(x.z, y.z, z.z));
}
