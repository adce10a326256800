// Guo, Zheng & Shi 2002, Phys. Rev. E 65:046308: S_i = w_i [3 (c_i - u).F + 9 (c_i.u)(c_i.F)], u = (j + F/2) / rho.
// Its Hermite moments are F, then u_a F_b + u_b F_a, and 0 above. The step is
// h* = h + R (h_eq - h - S/2) + S, which adds (1 - s/2) S to each moment.
// needs velocity, grid, $body_force

fn fluid_velocity(p: Place, rho: Real, j: Vector) -> Vector {
    let force = body_force(p);
    let inverse = 1.0 / rho;
    return Vector(
        (j.x + 0.5 * force.x) * inverse,
        (j.y + 0.5 * force.y) * inverse,
        (j.z + 0.5 * force.z) * inverse,
    );
}

fn add_moments(factor: f32, p: Place, u: Vector, h: ptr<function, array<Real, 27>>) {
    let force = body_force(p);
    let x = factor * force.x;
    let y = factor * force.y;
    let z = factor * force.z;
    (*h)[1u] += x;
    (*h)[3u] += y;
    (*h)[9u] += z;
    (*h)[2u] += 2.0 * u.x * x;
    (*h)[6u] += 2.0 * u.y * y;
    (*h)[18u] += 2.0 * u.z * z;
    (*h)[4u] += u.x * y + u.y * x;
    (*h)[10u] += u.x * z + u.z * x;
    (*h)[12u] += u.y * z + u.z * y;
}

fn take_half_source(p: Place, u: Vector, d: ptr<function, array<Real, 27>>) {
    add_moments(-0.5, p, u, d);
}

fn add_source(p: Place, u: Vector, h: ptr<function, array<Real, 27>>) {
    add_moments(1.0, p, u, h);
}
