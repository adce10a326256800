// Orlanski 1976, J. Comput. Phys. 21:251, on populations: those that enter through the face follow
// df/dt + (c_s + u_n) df/dn = 0, upwind from the inner neighbour, so that sound and vortices leave. Towards the
// given density they get hold times the difference and, so that none is left in the mean,
// integral times its sum over time.
// needs scalar_grid, incoming, weights, face_cells

// For each face cell its populations as the face will want them in the next step; in place of the
// one at rest the sum over time.
@group(0) @binding(41) var<storage, read_write> carried: array<f32>;

struct Inside {
    excess: f32,
    outward_speed: f32,
}

fn inside(at: Neighbourhood) -> Inside {
    var excess = read_incoming(at, 0u);
    var flux = 0.0;
    for (var q = 1u; q < 27u; q++) { // unroll
        let f = read_incoming(at, q);
        excess += f;
        flux += f * dot(vec3<f32>(C[q]), open_face.normal);
    }
    return Inside(excess, flux / (1.0 + excess));
}

fn remember_cell(n: u32, inner_state: Inside) {
    let here = face_cells[n];
    let cell = neighbourhood(padded_cell(here.cell));
    let inner = neighbourhood(padded_cell(here.inner));
    let speed = clamp(inverseSqrt(3.0) + inner_state.outward_speed, 0.0, 1.0);
    for (var q = 1u; q < 27u; q++) { // unroll
        if ((here.entering & (1u << q)) != 0u) {
            let f = read_incoming(cell, q);
            carried[27u * n + q] = f + speed * (read_incoming(inner, q) - f);
        }
    }
    // The density on the face, half a cell further out.
    let face_excess = 1.5 * inside(cell).excess - 0.5 * inner_state.excess;
    carried[27u * n] += open_face.integral * (open_face.density - 1.0 - face_excess);
}

@compute @workgroup_size(64)
fn remember(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = cell_pass.first + invocation(group, groups, local);
    if (n < cell_pass.end) {
        remember_cell(n, inside(neighbourhood(padded_cell(face_cells[n].inner))));
    }
}

@compute @workgroup_size(64)
fn flow_out(
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
    let difference = open_face.density - 1.0 - inside(neighbourhood(padded_cell(here.inner))).excess;
    let anchor = open_face.hold * difference + carried[27u * n];
    for (var q = 1u; q < 27u; q++) { // unroll
        if ((here.entering & (1u << q)) != 0u) {
            write_incoming(cell, q, carried[27u * n + q] + anchor * weight(q));
        }
    }
}
