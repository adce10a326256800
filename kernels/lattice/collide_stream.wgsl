// d'Humieres et al. 2002, Phil. Trans. R. Soc. A 360:437, eq. 1: f* = f + M^-1 S M (f_eq - f) + source, and streaming.
// One fused step of the fluid: load, transform to moments, collide, transform back, store. In moments h the step adds
// R (h_eq - h - s/2) + s with the rates R and the moments s of the body force.
// needs moments, stream, velocity, $bricks, $cell_flags, $psm, $equilibrium, $eddy, $force, $relax, $store_velocity, $guard, $sampling, workgroup

@compute @workgroup_size(WORKGROUP)
fn collide_stream(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let index = group.x + group.y * groups.x;
    if (index >= brick_count()) {
        return;
    }
    let p = place(brick_of(index), local);
    if (p.outside) {
        return;
    }
    let cell = cell_class(p);
    // Computed first, while few values are live.
    let psm = psm_cell(index, local);
    let tau_excess = tau_minus_half(p, cell, psm);
    let shear_rate = 1.0 / (0.5 + tau_excess);
    var f = load(p);
    var h = f;
    to_moments(&h);
    let excess = h[0u];
    let rho = 1.0 + excess;
    let u = fluid_velocity(p, rho, vec3_of(h[1u], h[3u], h[9u]));
    guard(p, out_of_range(cell, rho, u), index == 0u && local == 0u);
    store_velocity(p, cell, mean_velocity(psm, u));
    var d = equilibrium(rho, u);
    for (var k = 1u; k < 27u; k++) { // unroll
        d[k] -= h[k];
    }
    take_half_source(p, u, &d);
    // Only the change is transformed back from moments: its round-off is relative to the change, not to
    // f, so that weak forces are not lost in the round-off of f.
    let weights = collide_with_solid(p, index, local, cell, psm, tau_excess, third_order_rate(cell, psm, shear_rate), rho, u, &h);
    add_sample(p, cell, excess, rho, u, weights, &h);
    var change: array<Real, 27>;
    relax(cell, psm, shear_rate, &d, &change);
    add_source(p, u, &change);
    blend_with_solid(weights, &h, &change);
    from_moments(&change);
    for (var k = 0u; k < 27u; k++) { // unroll
        f[k] += change[k];
    }
    clear_solid(cell, &f);
    store(p, &f);
}
