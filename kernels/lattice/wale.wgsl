// Nicoud & Ducros 1999, Flow Turbul. Combust. 62:183, eq. 13: eddy viscosity that vanishes in pure
// shear and grows as y^3 at a wall. Lattice units, filter width one cell:
// nu_t = C_w^2 (Sd:Sd)^(3/2) / [(S:S)^(5/2) + (Sd:Sd)^(5/4)], Sd the traceless symmetric part of g g.
// needs velocity

// Rows of the velocity gradient, x.y = d u_x / d y.
struct Gradient {
    x: Vector,
    y: Vector,
    z: Vector,
}

fn wale(g: Gradient, constant: f32) -> Real {
    let s_xy = 0.5 * (g.x.y + g.y.x);
    let s_xz = 0.5 * (g.x.z + g.z.x);
    let s_yz = 0.5 * (g.y.z + g.z.y);
    let s = g.x.x * g.x.x + g.y.y * g.y.y + g.z.z * g.z.z
        + 2.0 * (s_xy * s_xy + s_xz * s_xz + s_yz * s_yz);

    let q_xx = g.x.x * g.x.x + g.x.y * g.y.x + g.x.z * g.z.x;
    let q_yy = g.y.x * g.x.y + g.y.y * g.y.y + g.y.z * g.z.y;
    let q_zz = g.z.x * g.x.z + g.z.y * g.y.z + g.z.z * g.z.z;
    let q_xy = g.x.x * g.x.y + g.x.y * g.y.y + g.x.z * g.z.y;
    let q_yx = g.y.x * g.x.x + g.y.y * g.y.x + g.y.z * g.z.x;
    let q_xz = g.x.x * g.x.z + g.x.y * g.y.z + g.x.z * g.z.z;
    let q_zx = g.z.x * g.x.x + g.z.y * g.y.x + g.z.z * g.z.x;
    let q_yz = g.y.x * g.x.z + g.y.y * g.y.z + g.y.z * g.z.z;
    let q_zy = g.z.x * g.x.y + g.z.y * g.y.y + g.z.z * g.z.y;
    let trace = (q_xx + q_yy + q_zz) * (1.0 / 3.0);
    let d_xx = q_xx - trace;
    let d_yy = q_yy - trace;
    let d_zz = q_zz - trace;
    let d_xy = 0.5 * (q_xy + q_yx);
    let d_xz = 0.5 * (q_xz + q_zx);
    let d_yz = 0.5 * (q_yz + q_zy);
    let d = d_xx * d_xx + d_yy * d_yy + d_zz * d_zz
        + 2.0 * (d_xy * d_xy + d_xz * d_xz + d_yz * d_yz);

    // d is a gradient to the 4th power, r and s are to the 2nd: nu_t = C^2 r^3 / (s^(5/2) + r^(5/2)).
    // Both are divided by the larger one, so that weak gradients do not underflow and the
    // denominator is at least 1 wherever there is a gradient.
    let r = sqrt(d);
    let scale = max(max(s, r), Real(1e-30));
    let a = s / scale;
    let b = r / scale;
    let denominator = max(a * a * sqrt(a) + b * b * sqrt(b), Real(0.5));
    return constant * constant * sqrt(scale) * b * b * b / denominator;
}
