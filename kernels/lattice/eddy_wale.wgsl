// Gardner & Sitar 2018, eq. 7: tau = 1/2 + 3 (nu + nu_t), nu_t by WALE from central differences of the
// velocity of the previous step.
// needs grid, velocity, velocities, wale, $cell_flags, $psm, $near_wall, $reals, $wale_interval

// tau - 1/2, which tau itself would round away at low viscosity.
override TAU_MINUS_HALF: f32;
override C_WALE: f32;

fn tau_minus_half(p: Place, cell: u32, psm: PsmCell) -> Real {
    let nu_t = outside_solids(psm, at_least_near_wall(p, resolved_eddy_viscosity(p, cell)));
    return select(TAU_MINUS_HALF + 3.0 * nu_t, Real(TAU_MINUS_HALF), solid(cell));
}

fn eddy_viscosity_of_gradient(p: Place, cell: u32) -> Real {
    let g = Gradient(
        component_gradient(p, cell, 0u),
        component_gradient(p, cell, 1u),
        component_gradient(p, cell, 2u),
    );
    return wale(g, C_WALE);
}

fn component_gradient(p: Place, cell: u32, component: u32) -> Vector {
    let here = unpack_reals(read_before(component, p.element));
    return Vector(
        difference(cell, 0u, before(p, component, vec3(-1, 0, 0)), here, before(p, component, vec3(1, 0, 0))),
        difference(cell, 2u, before(p, component, vec3(0, -1, 0)), here, before(p, component, vec3(0, 1, 0))),
        difference(cell, 4u, before(p, component, vec3(0, 0, -1)), here, before(p, component, vec3(0, 0, 1))),
    );
}

fn before(p: Place, component: u32, c: vec3<i32>) -> Real {
    return from_neighbour(p, c, unpack_reals(read_before(component, neighbour(p, c))));
}
