// Asmuth et al. 2021, Phys. Fluids 33:105111, for faces of blocks at an angle to the grid. The heights of the solid in columns of
// cells, along the axis nearest to the normal, give the face near each cell at the surface. The law of the wall reads the velocity
// in the column at least four cells from the face. block_friction_stored.wgsl lets the fluid slide in cells that the face cuts,
// and sloping_friction.wgsl applies the stress.
// needs surface_cells, sloping_cell, lattice

// Largest slope towards the nearest axis, above 1 since normals at equal angles to two axes are rounded.
const LARGEST_SLOPE = 1.2;
// Largest sum of the differences of height to the columns on both sides: more at edges.
const FLAT = 0.2;
// Cells from the surface in a column between full and empty cells, and cells up to the one whose velocity the law reads.
const PARTIAL = 4u;
const REACH = 12u;
// Distance of that cell from the face, at least, and distance up to which the eddy viscosity follows from the law.
const SAMPLE_DISTANCE = 4.0;
// In place of a height: the column has no full cells below, or no empty ones above.
const NO_COLUMN = -99.0;
const HIGH_COLUMN = 99.0;
// Full cells lie inside the surface, and their columns reach the edges of a convex solid only up to this distance, cells, on
// average: with it turned prisms have their area.
const EDGE_DEPTH = 1.2;
// Slope up to which faces at an edge count in part as along the grid.
const SLOPE_OF_EDGES = 0.2;
// Cells beside an edge up to which other solid makes the gap too narrow for a stream.
const EDGE_GAP = 4u;
// Ratio of the two largest components towards less solid from which a column may run along the second: where the only cells that
// are not full lie across an edge of the cell, both are equal, and the axis nearest to the normal may be the second.
const DIAGONAL = 0.9;

// Solid fraction of a cell.
fn fraction_at(cell: vec3<u32>) -> f32 {
    return fraction_in(psm_place(cell));
}

// The same, from the slot of its brick, from 1 or 0, and its place there.
fn fraction_in(at: vec2<u32>) -> f32 {
    return select(0.0, read_psm(PLANE_FRACTION, max(at.x, 1u) - 1u, at.y), at.x > 0u);
}

// A cell with its neighbours on the torus of the domain, or their mirror images beyond free-slip faces: the slot of (x + a, y + b, z + c) is psm_slots[brick_x[1 + a] +
// brick_y[1 + b] + brick_z[1 + c]], and its place is the sum of those of the axes, as psm_place has them.
struct PsmNeighbourhood {
    brick_x: vec3<u32>,
    brick_y: vec3<u32>,
    brick_z: vec3<u32>,
    place_x: vec3<u32>,
    place_y: vec3<u32>,
    place_z: vec3<u32>,
}

fn psm_neighbourhood(cell: vec3<u32>) -> PsmNeighbourhood {
    let mirrors = mirrors_of(cell);
    let x = on_ring(cell.x, CELLS_X, mirrors);
    let y = on_ring(cell.y, CELLS_Y, mirrors >> 2u);
    let z = on_ring(cell.z, CELLS_Z, mirrors >> 4u);
    let in_y = y % vec3(NY);
    let in_z = z % vec3(NZ);
    let bricks_x = (NX + BRICK_X - 1u) / BRICK_X;
    let bricks_y = (NY + BRICK_Y - 1u) / BRICK_Y;
    return PsmNeighbourhood(
        x / vec3(BRICK_X),
        bricks_x * (in_y / vec3(BRICK_Y)),
        bricks_x * bricks_y * (in_z / vec3(BRICK_Z)),
        LANES_OF_ELEMENT * (x % vec3(BRICK_X)),
        LANES_OF_ELEMENT * BRICK_X * (in_y % vec3(BRICK_Y)) + y / vec3(NY),
        LANES_OF_ELEMENT * BRICK_X * BRICK_Y * (in_z % vec3(BRICK_Z)) + z / vec3(NZ),
    );
}

// An index with those on both sides, by the bits of both for mirror images.
fn on_ring(i: u32, n: u32, mirrors: u32) -> vec3<u32> {
    let before = select(select(i - 1u, n - 1u, i == 0u), i, (mirrors & 1u) != 0u);
    let after = select(select(i + 1u, 0u, i + 1u == n), i, (mirrors & 2u) != 0u);
    return vec3(before, i, after);
}

// Height of the solid in the column of a cell, from its centre towards a face; NO_COLUMN or HIGH_COLUMN if the column is no full
// solid below no solid.
fn column_height(cell: vec3<u32>, face: u32) -> f32 {
    let own = fraction_at(cell);
    var height = own - 0.5;
    var at = cell;
    var fraction = own;
    for (var k = 0u; fraction > 0.0; k++) {
        if (k == PARTIAL) {
            return HIGH_COLUMN;
        }
        at = through(at, face, 1u);
        fraction = fraction_at(at);
        height += fraction;
    }
    at = cell;
    fraction = own;
    for (var k = 0u; fraction < FULL; k++) {
        if (k == PARTIAL) {
            return NO_COLUMN;
        }
        at = through(at, face ^ 1u, 1u);
        fraction = fraction_at(at);
        height += fraction - 1.0;
    }
    return height;
}

fn is_height(height: f32) -> bool {
    return height != NO_COLUMN && height != HIGH_COLUMN;
}

// The surface along an axis, from the columns on both sides.
struct Profile {
    // LARGEST_SLOPE or more where there is no flat face.
    slope: f32,
    // Distance by which the surface is longer than its part in the columns with full cells: where it turns by an angle, twice the
    // depth of these cells times the tangent of half the angle.
    longer: f32,
    // 1 at the edge of a face along the grid, 0 where there is no edge or the face slopes.
    straight: f32,
}

fn profile_along(cell: vec3<u32>, face: u32, axis: u32, height: f32) -> Profile {
    let before = column_height(beside(cell, 2u * axis), face);
    let after = column_height(beside(cell, 2u * axis + 1u), face);
    let rise = height - before;
    let next = after - height;
    if (is_height(before) && is_height(after)) {
        let half_angle = (rise - next) / (sqrt((1.0 + rise * rise) * (1.0 + next * next)) + 1.0 + rise * next);
        let slope = select(LARGEST_SLOPE, 0.5 * (after - before), abs(next - rise) <= FLAT);
        return Profile(slope, 2.0 * EDGE_DEPTH * half_angle, 0.0);
    }
    // At an edge the face is straight if the height does not change towards the other side.
    let change = abs(select(rise, next, is_height(after)));
    let straight = select(0.0, 1.0 - min(change / SLOPE_OF_EDGES, 1.0), is_height(before) || is_height(after));
    let above = fraction_at(through(cell, face, 1u));
    let below = beyond_edge(cell, 2u * axis, before, straight, above);
    return Profile(LARGEST_SLOPE, below + beyond_edge(cell, 2u * axis + 1u, after, straight, above), straight);
}

// Length by which this face, and the one around the edge if fluid lies in front of it, reach beyond the columns with full cells, on
// the side of a column with this height. Along the grid these are the cells that the faces cut, and the side of the cell.
fn beyond_edge(cell: vec3<u32>, side: u32, height: f32, straight: f32, above: f32) -> f32 {
    // A branch would spill registers on VEGA20.
    let faces = select(1.0, 2.0, has_fluid(cell, side, 0.5, 0u, EDGE_GAP));
    let along_grid = fraction_at(beside(cell, side)) + (faces - 1.0) * (1.0 + above);
    return select(0.0, mix(faces * EDGE_DEPTH, along_grid, straight), height == NO_COLUMN);
}

// Whether the cells of a column beyond `after` others, up to one of them, are fluid and hold no solid, if the face cannot cut them.
fn has_fluid(cell: vec3<u32>, face: u32, height: f32, after: u32, cells: u32) -> bool {
    var at = through(cell, face, after);
    for (var k = after + 1u; k <= cells; k++) {
        if ((flags_of(at) & ((1u << face) | SOLID)) != 0u) {
            return false;
        }
        at = through(at, face, 1u);
        if (f32(k) > height + 2.0 && fraction_at(at) > 0.0) {
            return false;
        }
    }
    return (flags_of(at) & SOLID) == 0u;
}

// Axis of the largest component; of equal ones that of the first, whatever rounding makes of them.
fn largest_axis(components: vec3<f32>) -> u32 {
    let size = abs(components) * vec3(1.0002, 1.0001, 1.0);
    return select(select(2u, 1u, size.y >= size.z), 0u, size.x >= size.y && size.x >= size.z);
}

fn face_towards(direction: vec3<f32>, axis: u32) -> u32 {
    return 2u * axis + select(0u, 1u, direction[axis] > 0.0);
}

// The sloping face at a cell at the surface of a block.
fn sloping_face(cell: vec3<u32>, here: Solid) -> SlopingCell {
    var found: SlopingCell;
    found.slope = NO_SLOPE;
    if (here.interior || here.several || !may_have_face(cell)) {
        return found;
    }
    // Towards less solid; the weights of Youngs 1984.
    let around = psm_neighbourhood(cell);
    var less = vec3(0.0);
    for (var q = 1u; q < 27u; q++) { // unroll
        let slot = psm_slots[around.brick_x[1 + C[q].x] + around.brick_y[1 + C[q].y] + around.brick_z[1 + C[q].z]];
        let place = around.place_x[1 + C[q].x] + around.place_y[1 + C[q].y] + around.place_z[1 + C[q].z];
        let fraction = fraction_in(vec2(slot, place));
        found.open |= select(0u, 1u << q, fraction < FULL);
        less -= f32(4u >> u32(abs(C[q].x) + abs(C[q].y) + abs(C[q].z) - 1)) * fraction * vec3<f32>(C[q]);
    }
    if (found.open == 0u || length(less) < 1e-3) {
        return found;
    }
    let first = largest_axis(less);
    var others = less;
    others[first] = 0.0;
    let second = largest_axis(others);
    let axes = select(1u, 2u, abs(less[second]) > DIAGONAL * abs(less[first]));
    var axis = first;
    var face = 0u;
    var height = NO_COLUMN;
    var nearest = 0u;
    var is_open = false;
    for (var n = 0u; n < axes && !is_open; n++) {
        axis = select(first, second, n == 1u);
        face = face_towards(less, axis);
        height = column_height(cell, face);
        // No face is nearer than this along the axis.
        nearest = u32(max(ceil(SAMPLE_DISTANCE + height), 0.0));
        is_open = is_height(height) && has_fluid(cell, face, height, 0u, nearest);
    }
    if (!is_open) {
        return found;
    }
    let up = less[axis] > 0.0;
    let along = vec2((axis + 1u) % 3u, (axis + 2u) % 3u);
    let profile_x = profile_along(cell, face, along.x, height);
    let profile_y = profile_along(cell, face, along.y, height);
    // At edges, the direction towards less solid.
    var normal = less;
    if (max(abs(profile_x.slope), abs(profile_y.slope)) < LARGEST_SLOPE) {
        normal[axis] = select(-1.0, 1.0, up);
        normal[along.x] = -profile_x.slope;
        normal[along.y] = -profile_y.slope;
    }
    found.normal = normalize(normal);
    let rise = abs(found.normal[axis]);
    let top = here.fraction >= FULL && fraction_at(through(cell, face, 1u)) < FULL;
    let cells = u32(ceil(SAMPLE_DISTANCE / rise + height));
    if (cells > REACH || !has_fluid(cell, face, height, nearest, cells)) {
        return found;
    }
    found.open = select(0u, found.open, here.fraction >= FULL);
    let own = mix(1.0 / rise, 1.0, max(profile_x.straight, profile_y.straight));
    found.area = select(0.0, max(own + profile_x.longer + profile_y.longer, 0.0), top);
    found.slope = face | select(0u, SLOPE_TOP, top) | (cells << SLOPE_CELLS) | (mirrors_of(cell) << SLOPE_FREE_SLIP);
    found.sample = scalar_of(through(cell, face, cells));
    found.distance = (f32(cells) - height) * rise;
    return found;
}

fn velocity_of_block(here: Solid) -> vec3<f32> {
    return vec3(
        read_psm(PLANE_VELOCITY, here.slot, here.place),
        read_psm(PLANE_VELOCITY + 1u, here.slot, here.place),
        read_psm(PLANE_VELOCITY + 2u, here.slot, here.place),
    );
}
