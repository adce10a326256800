// Asmuth et al. 2021, Phys. Fluids 33:105111: the law of the wall of wall_model.wgsl on grid-aligned faces of blocks. Computes
// the stress in each full cell under such a face, and the eddy viscosity of the fluid in front of it, from the velocity of the
// previous step; block_friction_stored.wgsl applies the stress.
// needs sloping_faces, near_wall_bits, mixing_length

// Whether the law acts on sloping faces.
override SLOPING: bool;
// Number of cells in front of a face whose eddy viscosity follows from the law; the law reads the velocity of the last one.
const DEPTH = 5u;
// The code of a cell that a face cuts is CUT less the face: of two faces the first one counts.
const CUT = 12u;
// Largest difference of the solid fractions of adjacent cells in front of a grid-aligned face.
const SLOPE = 0.1;

// Solid fraction of the neighbour through a face or of its mirror image; 0 if the neighbour is not fluid.
fn fraction_through(cell: vec3<u32>, face: u32) -> f32 {
    if ((flags_of(cell) & ~mirrors_of(cell) & (1u << face)) != 0u) {
        return 0.0;
    }
    return solid_at(beside(cell, face)).fraction;
}

// The face of a full cell where the law acts, or NO_FACE. It is the only open face of the cell, is grid-aligned up to its
// neighbours, and has five cells of fluid in front of it.
fn face_of(cell: vec3<u32>, here: Solid) -> u32 {
    if (here.fraction < FULL || here.interior || here.several || !may_have_face(cell)) {
        return NO_FACE;
    }
    var found = NO_FACE;
    for (var face = 0u; face < 6u; face++) {
        if (fraction_through(cell, face) < FULL) {
            if (found != NO_FACE) {
                return NO_FACE;
            }
            found = face;
        }
    }
    if (found == NO_FACE) {
        return NO_FACE;
    }
    let first = through(cell, found, 1u);
    let before = solid_at(first);
    if (before.several) {
        return NO_FACE;
    }
    for (var side = 0u; side < 6u; side++) {
        if (side / 2u != found / 2u && abs(fraction_through(first, side) - before.fraction) > SLOPE) {
            return NO_FACE;
        }
    }
    var at = first;
    for (var k = 0u; k < DEPTH; k++) {
        let flags = flags_of(at);
        let closed = (flags & SOLID) != 0u || (k + 1u < DEPTH && (flags & (1u << found)) != 0u);
        if (closed || (k > 0u && solid_at(at).fraction > 0.0)) {
            return NO_FACE;
        }
        at = through(at, found, 1u);
    }
    return found;
}

// Result of the law for a full cell under a face.
struct BlockFriction {
    // Stress over density, along the face; friction velocity; share of the law.
    stress: vec3<f32>,
    friction: f32,
    share: f32,
    // Solid fraction of the cell in front of the face.
    fraction: f32,
}

fn friction_under(cell: vec3<u32>, here: Solid, face: u32) -> BlockFriction {
    let first = through(cell, face, 1u);
    let fraction = solid_at(first).fraction;
    let at = scalar_of(through(first, face, DEPTH - 1u));
    var u: vec3<f32>;
    for (var a = 0u; a < 3u; a++) { // unroll
        u[a] = read_velocity(a, at) - read_psm(PLANE_VELOCITY + a, here.slot, here.place);
    }
    u[face / 2u] = 0.0;
    let speed = length(u);
    let stress = law_of_the_wall(speed, f32(DEPTH) - 0.5 - fraction, 0.0);
    let friction = sqrt(stress);
    return BlockFriction(stress / max(speed, 1e-30) * u, friction, model_share(friction), fraction);
}

// Runs after blocks have moved, before list_outer_cells and find_faces.
@compute @workgroup_size(1)
fn forget_outer_cells() {
    atomicStore(&outer_cells.count, 0u);
    atomicStore(&outer_cells.slopes, 0u);
}

// Lists the outer cells of one block each, so that find_faces visits only these: software adapters execute all branches of each
// invocation.
@compute @workgroup_size(64)
fn list_outer_cells(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let at = psm_invocation(invocation(group, groups, local));
    if (at.slot >= bricks[0u]) {
        return;
    }
    let place = at.element * LANES_OF_ELEMENT + at.lane;
    let number = number_of(at.slot, place);
    atomicStore(&face_codes[number], 0u);
    let sum = read_psm(PLANE_SUM, at.slot, place);
    // Grid-aligned faces are found from the full cells under them.
    let least = select(0.9, 0.0, SLOPING);
    if (sum > least && sum < INTERIOR_SUM && !decode_sum(sum).several && may_have_face(cell_at(at))) {
        outer_cells.cells[atomicAdd(&outer_cells.count, 1u)] = number;
    }
}

// Finds the faces where the law acts, and the cells that these faces cut.
@compute @workgroup_size(64)
fn find_faces(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let count = atomicLoad(&outer_cells.count);
    for (var n = invocation(group, groups, local); n < count; n += 64u * groups.x * groups.y) {
        let here = outer_cell(n);
        let face = face_of(here.cell, here.solid);
        if (face != NO_FACE) {
            atomicStore(&face_codes[here.number], bitcast<u32>(f32(face + 1u)));
            let first = psm_place(through(here.cell, face, 1u));
            if (first.x > 0u && solid_of(first.x - 1u, first.y).fraction > 0.0) {
                atomicMax(&face_codes[number_of(first.x - 1u, first.y)], bitcast<u32>(f32(CUT - face)));
            }
        }
    }
}

// Applies the law at these faces, for the next step.
@compute @workgroup_size(64)
fn block_friction(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let count = atomicLoad(&outer_cells.count);
    for (var n = invocation(group, groups, local); n < count; n += 64u * groups.x * groups.y) {
        let here = outer_cell(n);
        let face = face_above(here);
        if (face != NO_FACE) {
            apply_law(here, face);
        }
    }
}

// Runs at the end of the step, so that no eddy viscosity remains where a block moves away. At walls it is rewritten in each step.
@compute @workgroup_size(64)
fn clear_viscosity(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let count = atomicLoad(&outer_cells.count);
    for (var n = invocation(group, groups, local); n < count; n += 64u * groups.x * groups.y) {
        let here = outer_cell(n);
        let face = face_above(here);
        var before = here.cell;
        for (var k = 0u; k < DEPTH && face != NO_FACE; k++) {
            before = through(before, face, 1u);
            atomicStore(&near_wall_viscosity[scalar_of(before)], 0u);
        }
    }
}

fn apply_law(here: OuterCell, face: u32) {
    let law = friction_under(here.cell, here.solid, face);
    write_friction(here.solid.slot, here.solid.place, law);
    let first = psm_place(through(here.cell, face, 1u));
    if (law.fraction > 0.0 && atomicLoad(&face_codes[number_of(first.x - 1u, first.y)]) == bitcast<u32>(f32(CUT - face))) {
        write_friction(first.x - 1u, first.y, law);
    }
    var before = here.cell;
    for (var k = 0u; k < DEPTH; k++) {
        before = through(before, face, 1u);
        let y = f32(k) + 0.5 - law.fraction;
        let height = select(y, max(0.25, 0.5 * (1.0 - law.fraction)), k == 0u);
        let viscosity = KARMAN * height * taper(height) * law.friction * law.share;
        atomicMax(&near_wall_viscosity[scalar_of(before)], bitcast<u32>(viscosity));
    }
}

fn write_friction(slot: u32, place: u32, law: BlockFriction) {
    write_psm(PLANE_SHARE, slot, place, law.share);
    for (var a = 0u; a < 3u; a++) { // unroll
        write_psm(PLANE_STRESS + a, slot, place, law.stress[a]);
    }
}

// A face where the law acts, or the part of a sloping face in a column of cells.
struct BlockFace {
    // Index of the full cell under the face, in the padded grid.
    cell: u32,
    // Face of that cell, the nearest to a sloping one: x-, x+, y-, y+, z-, z+.
    face: u32,
    friction: f32,
    share: f32,
    stress: vec3<f32>,
    // Distance of the face beyond that cell along the axis of `face`, cells.
    fraction: f32,
    normal: vec3<f32>,
    // In faces of a cell.
    area: f32,
}

// Number of faces of full block cells in contact with fluid, and number of these where the law acts.
@group(0) @binding(43) var<storage, read_write> face_counts: array<atomic<u32>, 2>;
@group(0) @binding(44) var<storage, read_write> found_faces: array<BlockFace>;

// For output: the faces where the law acts, in no particular order.
@compute @workgroup_size(64)
fn list_block_faces(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let at = psm_invocation(invocation(group, groups, local));
    if (at.slot >= bricks[0u]) {
        return;
    }
    let cell = cell_at(at);
    if (any(cell >= vec3(CELLS_X, CELLS_Y, CELLS_Z))) {
        return;
    }
    let here = solid_of(at.slot, at.element * LANES_OF_ELEMENT + at.lane);
    if (here.fraction < FULL || here.interior) {
        return;
    }
    let face = face_of(cell, here);
    if (face == NO_FACE && SLOPING) {
        let sloping = sloping_face(cell, here);
        if (sloping.slope != NO_SLOPE) {
            if ((sloping.slope & SLOPE_TOP) != 0u) {
                atomicAdd(&face_counts[0], 1u);
                list_sloping_face(cell, here, sloping);
            }
            return;
        }
    }
    for (var side = 0u; side < 6u; side++) {
        let other = solid_at(through(cell, side, 1u));
        if ((flags_of(cell) & (1u << side)) == 0u && other.fraction < FULL && !other.several) {
            atomicAdd(&face_counts[0], 1u);
        }
    }
    if (face == NO_FACE) {
        return;
    }
    let n = atomicAdd(&face_counts[1], 1u);
    if (n < arrayLength(&found_faces)) {
        let law = friction_under(cell, here, face);
        var normal: vec3<f32>;
        normal[face / 2u] = select(-1.0, 1.0, face % 2u == 1u);
        found_faces[n] = BlockFace(padded_index(cell), face, law.friction, law.share, law.stress, law.fraction, normal, 1.0);
    }
}

fn list_sloping_face(cell: vec3<u32>, here: Solid, found: SlopingCell) {
    let n = atomicAdd(&face_counts[1], 1u);
    if (n < arrayLength(&found_faces)) {
        let law = law_at_slope(found, velocity_of_block(here), 0.0);
        let stress = law.friction * law.friction / max(length(law.u), 1e-30) * law.u;
        let face = law.slope & 7u;
        let beyond = f32(cells_to_sample(law.slope)) - 0.5 - law.distance / abs(law.normal[face / 2u]);
        found_faces[n] =
            BlockFace(padded_index(cell), face, law.friction, model_share(law.friction), stress, beyond, law.normal, law.area);
    }
}

fn padded_index(cell: vec3<u32>) -> u32 {
    return cell.x + NX * (cell.y + NY * LANES_Y * cell.z);
}
