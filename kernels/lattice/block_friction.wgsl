// Asmuth et al. 2021, Phys. Fluids 33:105111: the law of the wall of wall_model.wgsl on grid-aligned faces of blocks. Computes
// the stress in each full cell under such a face, and the eddy viscosity of the fluid in front of it, from the velocity of the
// previous step; block_friction_stored.wgsl applies the stress.
// needs psm_bricks, psm_places, psm_planes, psm_storage_written, cell_velocities, law_of_the_wall, mixing_length, $neighbour_flags

// Bits of non-negative floats, which have the order of the floats: a cell in front of two faces gets the larger value.
@group(0) @binding(42) var<storage, read_write> near_wall_viscosity: array<atomic<u32>>;
// Code of each cell of the bricks that blocks reach, as the bits of a float, for block_friction_stored.wgsl: 1 to 6 under a face
// x-, x+, y-, y+, z-, z+ where the law acts, see CUT for a cell that such a face cuts, 0 elsewhere.
@group(0) @binding(39) var<storage, read_write> face_codes: array<atomic<u32>>;

// Cells of blocks that may lie under such a face, by their number in these bricks (number_of).
struct OuterCells {
    count: atomic<u32>,
    cells: array<u32>,
}

@group(0) @binding(47) var<storage, read_write> outer_cells: OuterCells;

// Number of cells in front of a face whose eddy viscosity follows from the law; the law reads the velocity of the last one.
const DEPTH = 5u;
// The code of a cell that a face cuts is CUT less the face: of two faces the first one counts.
const CUT = 12u;
// Solid fraction from which a cell is full.
const FULL = 0.999;
// Largest difference of the solid fractions of adjacent cells in front of a grid-aligned face.
const SLOPE = 0.1;
const NO_FACE = 6u;
// Bits of the flags of a cell: the neighbour through a face is not fluid; the cell is not fluid.
const FACES = 63u;
const SOLID = 128u;

// The solid in a cell, with its place in the planes.
struct Solid {
    slot: u32,
    place: u32,
    fraction: f32,
    interior: bool,
    several: bool,
}

fn solid_of(slot: u32, place: u32) -> Solid {
    let sum = decode_sum(read_psm(PLANE_SUM, slot, place));
    let fraction = select(0.0, read_psm(PLANE_FRACTION, slot, place), sum.fraction > 0.0);
    return Solid(slot, place, fraction, sum.interior, sum.several);
}

fn solid_at(cell: vec3<u32>) -> Solid {
    let at = psm_place(cell);
    if (at.x == 0u) {
        return Solid(0u, 0u, 0.0, false, false);
    }
    return solid_of(at.x - 1u, at.y);
}

// The cell at distance `n` through a face, also across a periodic face.
fn through(cell: vec3<u32>, face: u32, n: u32) -> vec3<u32> {
    let size = vec3(CELLS_X, CELLS_Y, CELLS_Z);
    let axis = face / 2u;
    var other = cell;
    other[axis] = (cell[axis] + select(size[axis] - n, n, face % 2u == 1u)) % size[axis];
    return other;
}

// Solid fraction of the neighbour through a face; 0 if the neighbour is not fluid.
fn fraction_through(cell: vec3<u32>, face: u32) -> f32 {
    if ((flags_of(cell) & (1u << face)) != 0u) {
        return 0.0;
    }
    return solid_at(through(cell, face, 1u)).fraction;
}

// The face of a full cell where the law acts, or NO_FACE. It is the only open face of the cell, is grid-aligned up to its
// neighbours, and has five cells of fluid in front of it.
fn face_of(cell: vec3<u32>, here: Solid) -> u32 {
    let beyond = any(cell >= vec3(CELLS_X, CELLS_Y, CELLS_Z));
    if (beyond || here.fraction < FULL || here.interior || here.several || (flags_of(cell) & (FACES | SOLID)) != 0u) {
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

// Number of a cell of the bricks that blocks reach, slot by slot.
fn number_of(slot: u32, place: u32) -> u32 {
    return slot * BRICK_X * BRICK_Y * BRICK_Z * LANES_OF_ELEMENT + place;
}

struct OuterCell {
    cell: vec3<u32>,
    number: u32,
    solid: Solid,
}

fn outer_cell(n: u32) -> OuterCell {
    let number = outer_cells.cells[n];
    let of_brick = BRICK_X * BRICK_Y * BRICK_Z * LANES_OF_ELEMENT;
    let slot = number / of_brick;
    let place = number % of_brick;
    let cell = cell_at(PsmPlace(slot, place / LANES_OF_ELEMENT, place % LANES_OF_ELEMENT));
    return OuterCell(cell, number, solid_of(slot, place));
}

// The face that find_faces has found.
fn face_above(here: OuterCell) -> u32 {
    return min(u32(bitcast<f32>(atomicLoad(&face_codes[here.number]))) - 1u, NO_FACE);
}

// Runs after blocks have moved, before list_outer_cells and find_faces.
@compute @workgroup_size(1)
fn forget_outer_cells() {
    atomicStore(&outer_cells.count, 0u);
}

// Lists the outer cells, so that find_faces visits only these: software adapters execute all branches of each invocation.
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
    if (sum > 0.9 && sum < INTERIOR_SUM) {
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

// A face where the law acts.
struct BlockFace {
    // Index of the full cell under the face, in the padded grid.
    cell: u32,
    // Face of that cell: x-, x+, y-, y+, z-, z+.
    face: u32,
    friction: f32,
    share: f32,
    stress: vec3<f32>,
    // Distance of the face beyond that cell, cells.
    fraction: f32,
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
    for (var face = 0u; face < 6u; face++) {
        let closed = (flags_of(cell) & (1u << face)) != 0u;
        let other = solid_at(through(cell, face, 1u));
        if (!closed && other.fraction < FULL && !other.several) {
            atomicAdd(&face_counts[0], 1u);
        }
    }
    let face = face_of(cell, here);
    if (face == NO_FACE) {
        return;
    }
    let n = atomicAdd(&face_counts[1], 1u);
    if (n < arrayLength(&found_faces)) {
        let law = friction_under(cell, here, face);
        let index = cell.x + NX * (cell.y + NY * LANES_Y * cell.z);
        found_faces[n] = BlockFace(index, face, law.friction, law.share, law.stress, law.fraction);
    }
}
