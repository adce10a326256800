// Qian, d'Humieres & Lallemand 1992: weights of the D3Q27 lattice, products of 1/6, 2/3, 1/6.

fn weight(q: u32) -> f32 {
    if (q == 0u) {
        return 8.0 / 27.0;
    }
    if (q < 7u) {
        return 2.0 / 27.0;
    }
    return select(1.0 / 216.0, 1.0 / 54.0, q < 19u);
}
