// Lehmann 2022, Computation 10(6):92: location of the population that a cell loads next in direction q.
// For single cells only this file depends on the parity; see stream.wgsl.
// needs scalar_grid, scalars

struct Word {
    direction: u32,
    scalar: u32,
}

// A cell with its neighbours on the torus: the scalar of (x + a, y + b, z + c) is x[1 + a] + y[1 + b] + z[1 + c].
struct Neighbourhood {
    x: vec3<u32>,
    y: vec3<u32>,
    z: vec3<u32>,
}

fn neighbourhood(cell: vec3<u32>) -> Neighbourhood {
    let y = on_torus(cell.y, NY * LANES_Y);
    let z = on_torus(cell.z, NZ * LANES_Z);
    return Neighbourhood(
        LANES_OF_ELEMENT * on_torus(cell.x, NX),
        LANES_OF_ELEMENT * NX * (y % vec3(NY)) + y / vec3(NY),
        LANES_OF_ELEMENT * NX * NY * (z % vec3(NZ)) + z / vec3(NZ),
    );
}

fn on_torus(i: u32, n: u32) -> vec3<u32> {
    return vec3(select(i - 1u, n - 1u, i == 0u), i, select(i + 1u, 0u, i + 1u == n));
}

fn scalar_at(at: Neighbourhood, c: vec3<i32>) -> u32 {
    return at.x[1 + c.x] + at.y[1 + c.y] + at.z[1 + c.z];
}

fn incoming(at: Neighbourhood, q: u32) -> Word {
    if (q == 0u) {
        return Word(0u, scalar_at(at, vec3(0)));
    }
    if ((q & 1u) == 1u) {
        return Word(q + 1u - cell_pass.odd, scalar_at(at, vec3(0)));
    }
    return Word(q - 1u + cell_pass.odd, scalar_at(at, C[q - 1u]));
}

fn read_incoming(at: Neighbourhood, q: u32) -> f32 {
    let word = incoming(at, q);
    return read_scalar(word.direction, word.scalar);
}

fn write_incoming(at: Neighbourhood, q: u32, value: f32) {
    let word = incoming(at, q);
    write_scalar(word.direction, word.scalar, value);
}

// The word that the neighbour in direction q (not 0) loads next in that direction.
fn outgoing(at: Neighbourhood, q: u32) -> Word {
    if ((q & 1u) == 1u) {
        return Word(q + 1u - cell_pass.odd, scalar_at(at, C[q]));
    }
    return Word(q - 1u + cell_pass.odd, scalar_at(at, vec3(0)));
}

fn read_outgoing(at: Neighbourhood, q: u32) -> f32 {
    let word = outgoing(at, q);
    return read_scalar(word.direction, word.scalar);
}

fn write_outgoing(at: Neighbourhood, q: u32, value: f32) {
    let word = outgoing(at, q);
    write_scalar(word.direction, word.scalar, value);
}
