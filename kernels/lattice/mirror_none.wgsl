// Lehmann 2022, Computation 10(6):92: no full cell with an exact surface lies at a free-slip face, or the face reflects what leaves the
// cell afterwards.
// needs incoming

fn returned(at: Neighbourhood, slope: u32, q: u32) -> Word {
    return outgoing(at, q);
}
