// Contiguous ranges along x of the cells around a cell, in a domain that is not periodic.
// needs cell_grid

const CELL_RANGES = 25;

// Range n of the cells around `home`: from .x to before .y.
fn cell_range(home: vec3<i32>, n: i32) -> vec2<u32> {
    let y = home.y + n % 5 - 2;
    let z = home.z + n / 5 - 2;
    let inside = y >= 0 && y < CELLS_Y && z >= 0 && z < CELLS_Z;
    let row = (z * CELLS_Y + y) * CELLS_X;
    let cells = vec2(row + max(home.x - 2, 0), row + min(home.x + 3, CELLS_X));
    return vec2<u32>(select(vec2(0), cells, inside));
}

// Vector from b to a, spacings.
fn separation(a: vec3<i32>, b: vec3<i32>) -> vec3<f32> {
    return vec3<f32>(a - b) * QUANTUM;
}

fn wrapped(at: vec3<i32>) -> vec3<i32> {
    return at;
}
