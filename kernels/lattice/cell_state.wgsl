// Guo, Zheng & Shi 2002: density minus one and velocity of a domain cell, rho = 1 + sum f, rho u = sum c f + F/2; zero in
// solids.
// needs scalar_grid, incoming, $cell_force, $neighbour_flags

fn cell_state(cell: vec3<u32>) -> vec4<f32> {
    var excess = 0.0;
    var u = vec3(0.0);
    if ((flags_of(cell) & 128u) == 0u) {
        let at = neighbourhood(cell);
        excess = read_incoming(at, 0u);
        for (var q = 1u; q < 27u; q++) { // unroll
            let f = read_incoming(at, q);
            excess += f;
            u += f * vec3<f32>(C[q]);
        }
        u = (u + 0.5 * cell_force(cell)) / (1.0 + excess);
    }
    return vec4(excess, u);
}
