// Müller, Charypar & Gross 2003, SCA: poly6 for density, the gradient of the spiky function for pressure, and the
// Laplacian for viscosity, with the support of the delta-SPH scheme. In a plane the factors make W and r^2 Laplacian/4
// integrate to one.

// Support, spacings.
override REACH: f32;
// 315/(64 pi R^9), or 4/(pi R^8).
override POLY6: f32;
// 45/(pi R^6), or 30/(pi R^5).
override SPIKY: f32;
// 45/(pi R^6), or 40/(pi R^5).
override LAPLACIAN: f32;

fn poly6(square: f32) -> f32 {
    let a = REACH * REACH - square;
    return POLY6 * a * a * a;
}

// -W'(r) of the spiky function.
fn spiky_slope(r: f32) -> f32 {
    let a = REACH - r;
    return SPIKY * a * a;
}

fn laplacian(r: f32) -> f32 {
    return LAPLACIAN * (REACH - r);
}
