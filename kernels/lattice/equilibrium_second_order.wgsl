// Qian, d'Humieres & Lallemand 1992: equilibrium to second order in u; its higher Hermite moments are 0.
// needs velocity

fn equilibrium(rho: Real, u: Vector) -> array<Real, 27> {
    var h: array<Real, 27>;
    h[0u] = rho;
    h[1u] = rho * u.x;
    h[2u] = h[1u] * u.x;
    h[3u] = rho * u.y;
    h[4u] = h[1u] * u.y;
    h[6u] = h[3u] * u.y;
    h[9u] = rho * u.z;
    h[10u] = h[1u] * u.z;
    h[12u] = h[3u] * u.z;
    h[18u] = h[9u] * u.z;
    return h;
}
