// The cells around one, by rows along x; nothing is periodic.
// needs particle_grid

const RUNS = 25;

// Row n of the cells around `home`: from .x to before .y.
fn run(home: vec3<i32>, n: i32) -> vec2<u32> {
    let y = home.y + n % 5 - 2;
    let z = home.z + n / 5 - 2;
    let inside = y >= 0 && y < CELLS_Y && z >= 0 && z < CELLS_Z;
    let row = (z * CELLS_Y + y) * CELLS_X;
    let cells = vec2(row + max(home.x - 2, 0), row + min(home.x + 3, CELLS_X));
    return vec2<u32>(select(vec2(0), cells, inside));
}

// From b to a, spacings.
fn between(a: vec3<i32>, b: vec3<i32>) -> vec3<f32> {
    return vec3<f32>(a - b) * QUANTUM;
}

fn wrapped(at: vec3<i32>) -> vec3<i32> {
    return at;
}
