// Latt & Chopard 2006, Math. Comput. Simul. 72:165, regularised start: f = f_eq + f_neq with second moments
// Pi_ab = -rho tau/3 (d_a u_b + d_b u_a), so that the first steps carry the stress of the flow. With a body force
// sum c f = rho u - F/2 (Guo, Zheng & Shi 2002).
// needs scalar_grid, incoming, cell_gradient, moments, $equilibrium, $cell_force

override TAU: f32;
// 1 with the non-equilibrium part, 0 without.
override NON_EQUILIBRIUM: f32;

// Density minus one, of each domain cell.
@group(0) @binding(50) var<storage, read> density: array<f32>;

@compute @workgroup_size(64)
fn initialise(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= CELLS_X * CELLS_Y * CELLS_Z) {
        return;
    }
    let cell = domain_cell(n);
    let cell_flags = flags_of(cell);
    var h: array<Real, 27>;
    if ((cell_flags & 128u) == 0u) {
        let u = cell_velocity(cell);
        let rho = 1.0 + density[n];
        h = equilibrium(rho, Vector(u.x, u.y, u.z));
        h[0u] = density[n];
        let force = cell_force(cell);
        h[1u] -= 0.5 * force.x;
        h[3u] -= 0.5 * force.y;
        h[9u] -= 0.5 * force.z;
        let g = cell_gradient(cell, cell_flags);
        let factor = -NON_EQUILIBRIUM * rho * TAU / 3.0;
        h[2u] += 2.0 * factor * g.x.x;
        h[6u] += 2.0 * factor * g.y.y;
        h[18u] += 2.0 * factor * g.z.z;
        h[4u] += factor * (g.x.y + g.y.x);
        h[10u] += factor * (g.x.z + g.z.x);
        h[12u] += factor * (g.y.z + g.z.y);
        from_moments(&h);
    }
    let at = neighbourhood(cell);
    for (var q = 0u; q < 27u; q++) { // unroll
        write_incoming(at, q, h[T[q]]);
    }
}
