// Orlanski 1976, J. Comput. Phys. 21:251, on populations: populations that enter through the face follow
// df/dt + (c_s + u_n) df/dn = 0, upwind from the inner neighbour, so that sound and vortices leave. They are
// corrected by `hold` times the difference to the given density and, so that the mean difference vanishes,
// by `integral` times the sum of the difference over time.
// needs scalar_grid, incoming, weights, face_cells

// For each face cell the populations that enter through the face in the next step; in place of the
// population at rest, the sum over time.
@group(0) @binding(41) var<storage, read_write> outflow_state: array<f32>;

struct Inside {
    excess: f32,
    outward_speed: f32,
}

fn all_incoming(at: Neighbourhood) -> array<f32, 27> {
    var f: array<f32, 27>;
    for (var q = 0u; q < 27u; q++) { // unroll
        f[q] = read_incoming(at, q);
    }
    return f;
}

fn inside(f: array<f32, 27>, normal: vec3<f32>) -> Inside {
    var excess = f[0u];
    var flux = 0.0;
    for (var q = 1u; q < 27u; q++) { // unroll
        excess += f[q];
        flux += f[q] * dot(vec3<f32>(C[q]), normal);
    }
    return Inside(excess, flux / (1.0 + excess));
}

@compute @workgroup_size(64)
fn store_outflow(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = cell_pass.first + invocation(group, groups, local);
    if (n >= cell_pass.end) {
        return;
    }
    let here = face_cells[n];
    let face = open_faces[here.face];
    let own = all_incoming(neighbourhood(padded_cell(here.cell)));
    let inner = all_incoming(neighbourhood(padded_cell(here.inner)));
    let inner_state = inside(inner, face.normal);
    let speed = clamp(inverseSqrt(3.0) + inner_state.outward_speed, 0.0, 1.0);
    for (var q = 1u; q < 27u; q++) { // unroll
        if ((here.entering & (1u << q)) != 0u) {
            outflow_state[27u * n + q] = own[q] + speed * (inner[q] - own[q]);
        }
    }
    // The density on the face, half a cell further out.
    let face_excess = 1.5 * inside(own, face.normal).excess - 0.5 * inner_state.excess;
    outflow_state[27u * n] += face.integral * (held_excess(face, here.cell) - face_excess);
}

@compute @workgroup_size(64)
fn apply_outflow(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = cell_pass.first + invocation(group, groups, local);
    if (n >= cell_pass.end) {
        return;
    }
    let here = face_cells[n];
    let face = open_faces[here.face];
    let held = held_excess(face, here.cell);
    let cell = neighbourhood(padded_cell(here.cell));
    let inner_state = inside(all_incoming(neighbourhood(padded_cell(here.inner))), face.normal);
    let anchor = face.hold * (held - inner_state.excess) + outflow_state[27u * n];
    // All loads precede the first write, so that they are independent.
    var kept: array<f32, 27>;
    for (var q = 1u; q < 27u; q++) { // unroll
        kept[q] = outflow_state[27u * n + q];
    }
    for (var q = 1u; q < 27u; q++) { // unroll
        if ((here.entering & (1u << q)) != 0u) {
            write_incoming(cell, q, kept[q] + anchor * weight(q));
        }
    }
}
