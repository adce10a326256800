// Asmuth et al. 2021, Phys. Fluids 33:105111, for solids at rest with an exact surface, such as terrain. The host finds the faces of
// the surface once, as sloping_faces.wgsl finds those of blocks. The law reads the velocity of the previous step.
// needs wall_cells, sloping_exchange, mixing_length, $wall_blocks

// The cells of wall_cells: the full ones at the surface, and those that it cuts.
@group(0) @binding(49) var<storage, read_write> slopes: array<SlopingCell>;
// Of each cell the scalar of surface_fractions that takes its share of the law, or NO_PLACE.
@group(0) @binding(47) var<storage, read> share_places: array<u32>;
@group(0) @binding(38) var<storage, read_write> surface_fractions: array<f32>;
// The sums of sloping_exchange.wgsl over all cells.
@group(0) @binding(43) var<storage, read_write> all_slip_sums: array<atomic<i32>, 4>;

const NO_PLACE = 0xffffffffu;

// Share of the law at a cell; none with a block nearby.
fn share_at(n: u32) -> f32 {
    return select(model_share(slopes[n].friction), 0.0, has_block(n));
}

// Evaluates the law.
@compute @workgroup_size(64)
fn surface_law(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n < 4u) {
        atomicStore(&all_slip_sums[n], 0);
    }
    if (n < arrayLength(&wall_cells)) {
        slopes[n] = law_at_slope(slopes[n], vec3(0.0), wall_cells[n].roughness);
    }
}

// Runs before the collision, after blocks have moved: the fluid slides in the cells that the surface cuts.
@compute @workgroup_size(64)
fn surface_shares(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n < arrayLength(&wall_cells) && share_places[n] != NO_PLACE) {
        surface_fractions[share_places[n]] = share_at(n);
    }
}

// A cell of fluid near the surface.
struct NearCell {
    scalar: u32,
    // The nearest face, by its number among the cells of wall_cells, and the distance from it, cells.
    face: u32,
    distance: f32,
}

@group(0) @binding(41) var<storage, read> near_cells: array<NearCell>;
@group(0) @binding(42) var<storage, read_write> near_wall_viscosity: array<f32>;

// Sets the eddy viscosity of these cells.
@compute @workgroup_size(64)
fn surface_viscosity(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n < arrayLength(&near_cells)) {
        let near = near_cells[n];
        near_wall_viscosity[near.scalar] =
            KARMAN * near.distance * taper(near.distance) * slopes[near.face].friction * share_at(near.face);
    }
}

// Runs before surface_friction, which applies the stress to the populations that the full cells have returned.
@compute @workgroup_size(64)
fn surface_slip(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    clear_slip_sums(local);
    let n = invocation(group, groups, local);
    if (n < arrayLength(&wall_cells)) {
        let share = share_at(n);
        if (slopes[n].open != 0u && share > 0.0) {
            slopes[n] = slip_at_slope(slopes[n], padded_cell(wall_cells[n].cell), vec3(0.0), share);
            add_to_slip_sums(slopes[n]);
        }
    }
    workgroupBarrier();
    if (local < 4u) {
        atomicAdd(&all_slip_sums[local], atomicLoad(&slip_sums[local]));
    }
}

@compute @workgroup_size(64)
fn surface_friction(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= arrayLength(&wall_cells)) {
        return;
    }
    let balance = slip_balance(
        atomicLoad(&all_slip_sums[0u]),
        atomicLoad(&all_slip_sums[1u]),
        atomicLoad(&all_slip_sums[2u]),
        atomicLoad(&all_slip_sums[3u]),
    );
    let face = slopes[n];
    if (face.open != 0u && share_at(n) > 0.0) {
        _ = exchange_at_slope(face, padded_cell(wall_cells[n].cell), balance);
    }
}
