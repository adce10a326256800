// Malaspinas 2015, arXiv:1505.06900: equilibrium to Gauss-Hermite order 6, h_abc = rho u_x^a u_y^b u_z^c.
// needs velocity

fn equilibrium(rho: Real, u: Vector) -> array<Real, 27> {
    var h: array<Real, 27>;
    h[0u] = rho;
    h[1u] = rho * u.x;
    h[2u] = h[1u] * u.x;
    for (var k = 0u; k < 3u; k++) { // unroll
        h[3u + k] = h[k] * u.y;
        h[6u + k] = h[3u + k] * u.y;
    }
    for (var k = 0u; k < 9u; k++) { // unroll
        h[9u + k] = h[k] * u.z;
        h[18u + k] = h[9u + k] * u.z;
    }
    return h;
}
