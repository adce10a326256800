// d'Humieres et al. 2002, Phil. Trans. R. Soc. A 360:437, eq. 1: f* = f + M^-1 S M (f_eq - f) + source, and streaming.
// One step of the fluid, fused: load, moments, collide, back, store. In moments h the step adds
// R (h_eq - h - s/2) + s with the rates R and the moments s of the body force.
// needs moments, stream, velocity, $where, $cells, $saturation, $equilibrium, $eddy, $force, $relax, $keep, $guard, workgroup

@compute @workgroup_size(WORKGROUP)
fn collide_stream(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let turn = group.x + group.y * groups.x;
    if (turn >= brick_count()) {
        return;
    }
    let p = place(brick_of(turn), local);
    if (p.outside) {
        return;
    }
    let cell = cell_class(p);
    // First, while few values are held.
    let saturation = saturation_of(turn, local);
    let excess = relaxation_excess(p, cell, saturation);
    let shear_rate = 1.0 / (0.5 + excess);
    var f = load(p);
    var h = f;
    to_moments(&h);
    let rho = 1.0 + h[0u];
    let u = fluid_velocity(p, rho, vec3_of(h[1u], h[3u], h[9u]));
    let bad = out_of_range(cell, rho, u);
    keep_velocity(p, cell, mean_velocity(saturation, u));
    var d = equilibrium(rho, u);
    for (var k = 1u; k < 27u; k++) { // unroll
        d[k] -= h[k];
    }
    take_half_source(p, u, &d);
    // Only the change goes back from moments: its round-off is a share of the change, not of f, and
    // weak forces are not lost beside it.
    var change: array<Real, 27>;
    relax(cell, saturation, shear_rate, &d, &change);
    add_source(p, u, &change);
    saturate(p, turn, local, cell, saturation, excess, rho, u, &h, &change);
    from_moments(&change);
    for (var k = 0u; k < 27u; k++) { // unroll
        f[k] += change[k];
    }
    clear_solid(cell, &f);
    store(p, &f);
    guard(p, bad, turn == 0u && local == 0u);
}
