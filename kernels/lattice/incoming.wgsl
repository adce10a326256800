// Lehmann 2022, Computation 10(6):92: where the population lies that a cell loads next in direction q.
// The one place that knows the parity for single cells: see stream.wgsl.
// needs scalar_grid, scalars

struct Word {
    direction: u32,
    scalar: u32,
}

fn incoming(cell: vec3<u32>, q: u32) -> Word {
    if (q == 0u) {
        return Word(0u, scalar_of(cell));
    }
    if ((q & 1u) == 1u) {
        return Word(q + 1u - cell_pass.odd, scalar_of(cell));
    }
    return Word(q - 1u + cell_pass.odd, scalar_of(neighbour_cell(cell, C[q - 1u])));
}

fn read_incoming(cell: vec3<u32>, q: u32) -> f32 {
    let word = incoming(cell, q);
    return read_scalar(word.direction, word.scalar);
}

fn write_incoming(cell: vec3<u32>, q: u32, value: f32) {
    let word = incoming(cell, q);
    write_scalar(word.direction, word.scalar, value);
}
