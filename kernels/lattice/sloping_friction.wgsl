// Asmuth et al. 2021, Phys. Fluids 33:105111, for faces of blocks at an angle to the grid.
// needs sloping_faces, sloping_exchange, near_wall_bits, mixing_length

// The faces found at outer_cells, in no particular order.
@group(0) @binding(49) var<storage, read_write> slopes: array<SlopingCell>;

// Runs after find_faces, at cells without a grid-aligned face.
@compute @workgroup_size(64)
fn find_slopes(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let count = atomicLoad(&outer_cells.count);
    for (var n = invocation(group, groups, local); n < count; n += 64u * groups.x * groups.y) {
        let here = outer_cell(n);
        if (atomicLoad(&face_codes[here.number]) == 0u) {
            var face = sloping_face(here.cell, here.solid);
            if (face.slope != NO_SLOPE) {
                face.outer = n;
                slopes[atomicAdd(&outer_cells.slopes, 1u)] = face;
                let code = select(SLIDES, FULL_AT_SLOPE, here.solid.fraction >= FULL);
                atomicStore(&face_codes[here.number], bitcast<u32>(f32(code)));
            }
        }
    }
}

// Applies the law at these faces, for the next step: data for the cells that they cut, and the eddy viscosity of the fluid above.
@compute @workgroup_size(64)
fn slope_law(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let count = atomicLoad(&outer_cells.slopes);
    for (var n = invocation(group, groups, local); n < count; n += 64u * groups.x * groups.y) {
        apply_at_slope(n, outer_cell(slopes[n].outer));
    }
}

fn apply_at_slope(n: u32, here: OuterCell) {
    let law = law_at_slope(slopes[n], velocity_of_block(here.solid), 0.0);
    slopes[n].u = law.u;
    slopes[n].friction = law.friction;
    let share = model_share(law.friction);
    write_psm(PLANE_SHARE, here.solid.slot, here.solid.place, share);
    if (here.solid.fraction < FULL) {
        for (var a = 0u; a < 3u; a++) { // unroll
            write_psm(PLANE_STRESS + a, here.solid.slot, here.solid.place, law.normal[a]);
        }
    }
    if (share > 0.0) {
        set_viscosity_above(law, here.cell, law.friction * share);
    }
}

// Runs at the end of the step, as clear_viscosity does.
@compute @workgroup_size(64)
fn clear_above_slopes(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    if (invocation(group, groups, local) < 4u) {
        atomicStore(&outer_cells.slip_sums[local], 0);
    }
    let count = atomicLoad(&outer_cells.slopes);
    for (var n = invocation(group, groups, local); n < count; n += 64u * groups.x * groups.y) {
        clear_viscosity_above(slopes[n], outer_cell(slopes[n].outer).cell);
    }
}

fn clear_viscosity_above(face: SlopingCell, cell: vec3<u32>) {
    let cells = select(0u, cells_to_sample(face.slope), (face.slope & SLOPE_TOP) != 0u);
    for (var k = 1u; k <= cells; k++) {
        atomicStore(&near_wall_viscosity[scalar_of(through(cell, face.slope & 7u, k))], 0u);
    }
}

// Sets the eddy viscosity of the fluid above the uppermost full cell of a column to that of the mixing length, where that of no
// other face is larger.
fn set_viscosity_above(face: SlopingCell, cell: vec3<u32>, friction: f32) {
    if ((face.slope & SLOPE_TOP) == 0u) {
        return;
    }
    let nearest = face.slope & 7u;
    let cells = cells_to_sample(face.slope);
    let rise = abs(face.normal[nearest / 2u]);
    var at = cell;
    for (var k = 1u; k <= cells; k++) {
        at = through(at, nearest, 1u);
        let y = face.distance - f32(cells - k) * rise;
        if (y > 1.0 || (y > 0.0 && fraction_at(at) == 0.0)) {
            atomicMax(&near_wall_viscosity[scalar_of(at)], bitcast<u32>(KARMAN * y * taper(y) * friction));
        }
    }
}

// Runs after the collision of the bricks that blocks reach; its parity is that of the next step.
@compute @workgroup_size(64)
fn sloping_slip(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    clear_slip_sums(local);
    let count = atomicLoad(&outer_cells.slopes);
    for (var n = invocation(group, groups, local); n < count; n += 64u * groups.x * groups.y) {
        let share = model_share(slopes[n].friction);
        if (slopes[n].open != 0u && share > 0.0) {
            let here = outer_cell(slopes[n].outer);
            slopes[n] = slip_at_slope(slopes[n], here.cell, velocity_of_block(here.solid), share);
            add_to_slip_sums(slopes[n]);
        }
    }
    workgroupBarrier();
    if (local < 4u) {
        atomicAdd(&outer_cells.slip_sums[local], atomicLoad(&slip_sums[local]));
    }
}

// Runs after it.
@compute @workgroup_size(64)
fn sloping_friction(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let balance = slip_balance(
        atomicLoad(&outer_cells.slip_sums[0u]),
        atomicLoad(&outer_cells.slip_sums[1u]),
        atomicLoad(&outer_cells.slip_sums[2u]),
        atomicLoad(&outer_cells.slip_sums[3u]),
    );
    let count = atomicLoad(&outer_cells.slopes);
    for (var n = invocation(group, groups, local); n < count; n += 64u * groups.x * groups.y) {
        if (slopes[n].open != 0u && model_share(slopes[n].friction) > 0.0) {
            apply_sloping_friction(slopes[n], outer_cell(slopes[n].outer), balance);
        }
    }
}

fn apply_sloping_friction(face: SlopingCell, here: OuterCell, balance: f32) {
    let gained = exchange_at_slope(face, here.cell, balance);
    // The block loses what the fluid gains.
    let parts = decode_sum(read_psm(PLANE_SUM, here.solid.slot, here.solid.place)).fraction;
    for (var a = 0u; a < 3u; a++) { // unroll
        let before = read_psm(PLANE_G + a, here.solid.slot, here.solid.place);
        write_psm(PLANE_G + a, here.solid.slot, here.solid.place, before + gained[a] / parts);
    }
}
