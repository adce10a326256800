// Contiguous ranges along x of the cells around a cell, with periodic axes. A period has at least five cells, so that no
// cell is visited twice.
// needs cell_grid

// Quanta; 0 along axes that are not periodic.
override PERIOD_X: i32;
override PERIOD_Y: i32;
override PERIOD_Z: i32;

// Rows along x, and the part of each row beyond an end of the period.
const ROWS = 25;
const CELL_RANGES = 50;

// Range n of the cells around `home`: from .x to before .y.
fn cell_range(home: vec3<i32>, n: i32) -> vec2<u32> {
    let row_of = n % ROWS;
    var y = home.y + row_of % 5 - 2;
    var z = home.z + row_of / 5 - 2;
    y = select(y, (y + CELLS_Y) % CELLS_Y, PERIOD_Y > 0);
    z = select(z, (z + CELLS_Z) % CELLS_Z, PERIOD_Z > 0);
    let inside = y >= 0 && y < CELLS_Y && z >= 0 && z < CELLS_Z;
    let reach = vec2(home.x - 2, home.x + 3);
    var cells = clamp(reach, vec2(0), vec2(CELLS_X));
    if (n >= ROWS) {
        // Cells beyond one end of the period are at its other end.
        let below = vec2(CELLS_X + min(reach.x, 0), CELLS_X);
        let above = vec2(0, max(reach.y - CELLS_X, 0));
        cells = select(vec2(0), select(above, below, reach.x < 0), PERIOD_X > 0);
    }
    let row = (z * CELLS_Y + y) * CELLS_X;
    return vec2<u32>(select(vec2(0), row + cells, inside));
}

// Vector from the nearest image of b to a, spacings.
fn separation(a: vec3<i32>, b: vec3<i32>) -> vec3<f32> {
    let period = vec3(PERIOD_X, PERIOD_Y, PERIOD_Z);
    var d = a - b;
    d -= select(vec3(0), period, 2 * d > period);
    d += select(vec3(0), period, 2 * d < -period);
    return vec3<f32>(d) * QUANTUM;
}

fn wrapped(at: vec3<i32>) -> vec3<i32> {
    let period = vec3(PERIOD_X, PERIOD_Y, PERIOD_Z);
    let modulus = max(period, vec3(1));
    // Of negative numbers % is undefined in GLSL.
    let over = abs(at) % modulus;
    let inside = select(over, modulus - over, (at < vec3(0)) & (over > vec3(0)));
    return select(at, inside, period > vec3(0));
}
