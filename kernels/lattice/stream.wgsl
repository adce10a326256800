// Lehmann 2022, Computation 10(6):92, Esoteric-Pull: in-place streaming, one owner per population and step.
// For each pair of opposite directions (q, r = q + 1) a cell owns two words: one of its own and one
// at its neighbour in direction q. Odd and even steps exchange the roles of the words of a pair, so
// that a cell loads in the next step the populations that its neighbours have stored.
// needs lattice, grid, populations, $store

// Parity of the step that loads.
override ODD: u32;

fn load(p: Place) -> array<Real, 27> {
    var f: array<Real, 27>;
    f[T[0u]] = decode(read_word(0u, p.element));
    for (var q = 1u; q < 27u; q += 2u) { // unroll
        f[T[q]] = decode(read_word(q + 1u - ODD, p.element));
        f[T[q + 1u]] = from_neighbour(p, C[q], decode(read_word(q + ODD, neighbour(p, C[q]))));
    }
    return f;
}

fn store(p: Place, f: ptr<function, array<Real, 27>>) {
    write_word(0u, p.element, encode((*f)[T[0u]]));
    for (var q = 1u; q < 27u; q += 2u) { // unroll
        write_word(q + ODD, neighbour(p, C[q]), encode(to_neighbour(p, C[q], (*f)[T[q]])));
        write_word(q + 1u - ODD, p.element, encode((*f)[T[q + 1u]]));
    }
}
