// Latt et al. 2008, Phys. Rev. E 77:056703, regularised boundary, with the state of the inner neighbour: the
// populations that enter through the face are rebuilt from density, velocity and second moments,
// f_i = w_i [rho + 3 c.j + 9/2 (c c - 1/3) : (rho u u + Pi_neq)]. The density is the given one, so that the
// face reflects sound.
// needs scalar_grid, incoming, weights, face_cells

@compute @workgroup_size(64)
fn hold_pressure(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = cell_pass.first + invocation(group, groups, local);
    if (n >= cell_pass.end) {
        return;
    }
    let here = face_cells[n];
    let cell = neighbourhood(padded_cell(here.cell));
    let inner = neighbourhood(padded_cell(here.inner));
    var excess = read_incoming(inner, 0u);
    var j = vec3(0.0);
    var diagonal = vec3(-excess / 3.0);
    var mixed = vec3(0.0);
    for (var q = 1u; q < 27u; q++) { // unroll
        let f = read_incoming(inner, q);
        let c = vec3<f32>(C[q]);
        excess += f;
        j += f * c;
        diagonal += f * (c * c - 1.0 / 3.0);
        mixed += f * c.xyz * c.yzx;
    }
    // The density is given on the face, half a cell beyond this cell and one and a half beyond the
    // inner one; velocity and stress are as they are inside.
    let held = held_excess(open_faces[here.face], here.cell);
    let change = (held - excess) * (2.0 / 3.0);
    let u = j / (1.0 + excess);
    let rho_excess = excess + change;
    let flux = j + change * u;
    let along = diagonal + change * u * u;
    let across = mixed + change * u.xyz * u.yzx;
    for (var q = 1u; q < 27u; q++) { // unroll
        if ((here.entering & (1u << q)) != 0u) {
            let c = vec3<f32>(C[q]);
            let second = dot(c * c - 1.0 / 3.0, along) + 2.0 * dot(c.xyz * c.yzx, across);
            write_incoming(cell, q, weight(q) * (rho_excess + 3.0 * dot(c, flux) + 4.5 * second));
        }
    }
}
