// Gardner & Sitar 2018, section 3.4: the cells at the surfaces of blocks, for the wall model: block_friction.wgsl and
// sloping_friction.wgsl.
// needs psm_bricks, psm_places, psm_planes, psm_storage_written, $neighbour_flags

// Code of each cell of the bricks that blocks reach, as the bits of a float, for block_friction_stored.wgsl: 1 to 6 under a
// grid-aligned face x-, x+, y-, y+, z-, z+ where the law acts, see CUT for a cell that such a face cuts, SLIDES, FULL_AT_SLOPE, 0 elsewhere.
@group(0) @binding(39) var<storage, read_write> face_codes: array<atomic<u32>>;

// Cells at the surfaces of blocks, by their number in these bricks (number_of), the number of sloping faces among these, and the sums
// of sloping_exchange.wgsl over them.
struct OuterCells {
    count: atomic<u32>,
    slopes: atomic<u32>,
    slip_sums: array<atomic<i32>, 4>,
    cells: array<u32>,
}

@group(0) @binding(47) var<storage, read_write> outer_cells: OuterCells;

// Solid fraction from which a cell is full.
const FULL = 0.999;
const NO_FACE = 6u;
// The codes of a cell that a sloping face cuts, and of a full cell at one.
const SLIDES = 13u;
const FULL_AT_SLOPE = 14u;
// Bits of the flags of a cell: the neighbour through a face is not fluid; the cell is not fluid.
const FACES = 63u;
const SOLID = 128u;
// The free-slip faces of the domain, one bit each for x-, x+, ...
override FREE_SLIP: u32;

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

// The faces of a cell that are free-slip faces of the domain, one bit each: beyond them the domain continues as its mirror image.
fn mirrors_of(cell: vec3<u32>) -> u32 {
    let low = cell == vec3(0u);
    let high = cell + 1u == vec3(CELLS_X, CELLS_Y, CELLS_Z);
    let x = select(0u, 1u, low.x) | select(0u, 2u, high.x);
    let y = select(0u, 4u, low.y) | select(0u, 8u, high.y);
    let z = select(0u, 16u, low.z) | select(0u, 32u, high.z);
    return (x | y | z) & FREE_SLIP;
}

// Whether a cell lies in the domain, away from walls.
fn may_have_face(cell: vec3<u32>) -> bool {
    let walls = flags_of(cell) & (FACES | SOLID) & ~mirrors_of(cell);
    return all(cell < vec3(CELLS_X, CELLS_Y, CELLS_Z)) && walls == 0u;
}

// The neighbour of a cell through a face, or its mirror image, the cell itself.
fn beside(cell: vec3<u32>, face: u32) -> vec3<u32> {
    return select(through(cell, face, 1u), cell, (mirrors_of(cell) & (1u << face)) != 0u);
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
