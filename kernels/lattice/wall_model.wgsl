// Asmuth, Janssen, Olivares-Espinosa & Ivanell 2021, Phys. Fluids 33:105111: the stress of a law of the wall, imposed through the
// velocity of the wall in half-way bounce-back. The populations return less 6 w c.m with m = 3 (2 P - stress), where P is the
// tangential momentum that arrives at the wall, so that the fluid loses the stress exactly. The law reads the velocity of the
// previous step in the fifth cell. Where the flow is laminar, m goes to 0 and the wall is bit-identical to a no-slip wall.
// In the cells at an edge between two walls the links into both return the stress of both, along the edge.
// P is without that of fluid at rest, in which the pressure balances the body force.
// needs wall_cells, scalars, link, cell_velocities, law_of_the_wall, mixing_length, balanced_cell_force, $wall_blocks

struct WallStress {
    // Tangential stress on the wall, along the lower and the upper axis of the face.
    stress: vec2<f32>,
    // Friction velocity of the law, and share of the stress that follows from the law: 0 for no slip, 1 for the law alone.
    friction: f32,
    share: f32,
}

// Links into the wall, nine per cell: link j of all cells precedes link j + 1. The tangential direction of link j is j % 3 - 1
// along the lower and j / 3 - 1 along the upper axis of the face. Of a cell at an edge, ten: link j goes backwards along the edge if j
// is even, forwards if it is odd; the first four go straight into one of the two walls.
@group(0) @binding(41) var<storage, read> wall_links: array<Link>;
@group(0) @binding(42) var<storage, read_write> near_wall_viscosity: array<f32>;
@group(0) @binding(43) var<storage, read_write> wall_stress: array<WallStress>;

// The cell, counted from 0, whose velocity the law reads.
const SAMPLE = 4u;

// Result of the law of the wall for a wall cell.
struct Friction {
    // Tangential velocity that the law reads, its magnitude, and the stress over the density.
    velocity: vec2<f32>,
    speed: f32,
    stress: f32,
    // Friction velocity, and the share of the law.
    friction: f32,
    share: f32,
}

fn friction_of(here: WallCell, blocked: bool) -> Friction {
    return friction_at(here, along_wall(velocity_above(here), here.face / 2u), blocked);
}

fn friction_at(here: WallCell, u: vec2<f32>, blocked: bool) -> Friction {
    let speed = length(u);
    let stress = law_of_the_wall(speed, f32(SAMPLE) + 0.5, here.roughness);
    let friction = sqrt(stress);
    return Friction(u, speed, stress, friction, select(model_share(friction), 0.0, blocked));
}

// Sets the eddy viscosity of the cells next to the wall.
fn set_near_wall(here: WallCell, law: Friction) {
    for (var layer = 0u; layer < 4u; layer++) { // unroll
        if (layer < here.layers) {
            near_wall_viscosity[scalar_of(layer_cell(here, layer))] =
                taper(f32(layer) + 0.5) * KARMAN * (f32(layer) + 0.5) * law.friction * law.share;
        }
    }
}

// Sets only this eddy viscosity, for a complete state at the start or after a restart.
@compute @workgroup_size(64)
fn near_wall(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n < arrayLength(&wall_cells)) {
        set_near_wall(wall_cells[n], friction_of(wall_cells[n], false));
    }
}

@compute @workgroup_size(64)
fn wall_model(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    let count = arrayLength(&wall_cells);
    if (n >= count) {
        return;
    }
    let here = wall_cells[n];
    let law = friction_of(here, has_block(n));
    set_near_wall(here, law);
    var f: array<f32, 9>;
    var arriving = vec2(0.0);
    for (var j = 0u; j < 9u; j++) { // unroll
        f[j] = read_arrived(wall_links[j * count + n]);
        arriving += f[j] * vec2(f32(j % 3u) - 1.0, f32(j / 3u) - 1.0);
    }
    arriving -= along_wall(balanced_force(padded_cell(here.cell)), here.face / 2u) * (1.0 / 12.0);
    let full = 3.0 * (2.0 * arriving - law.stress / max(law.speed, 1e-30) * law.velocity);
    // Limits m to twice the velocity that the law has read.
    let momentum = law.share * full * min(1.0, 2.0 * law.speed / max(length(full), 1e-30));
    for (var j = 0u; j < 9u; j++) { // unroll
        let a = j % 3u;
        let b = j / 3u;
        let corner = select(select(1.0 / 54.0, 2.0 / 27.0, a == 1u && b == 1u), 1.0 / 216.0, a != 1u && b != 1u);
        let back = 6.0 * corner * dot(vec2(f32(a) - 1.0, f32(b) - 1.0), momentum);
        write_returned(wall_links[j * count + n], f[j] - back);
    }
    wall_stress[n] = WallStress(2.0 * arriving - momentum / 3.0, law.friction, law.share);
}

// The velocity in the cell that the law reads.
fn velocity_above(here: WallCell) -> vec3<f32> {
    let at = scalar_of(layer_cell(here, SAMPLE));
    return vec3(read_velocity(0u, at), read_velocity(1u, at), read_velocity(2u, at));
}

// The components of a vector along the lower and the upper axis of a face normal to an axis.
fn along_wall(u: vec3<f32>, axis: u32) -> vec2<f32> {
    return select(select(u.xy, u.xz, axis == 1u), u.yz, axis == 0u);
}

// A cell at an edge: its entries in wall_cells are 2n and 2n + 1, the first with the eddy viscosity of the cell.
struct Edge {
    // The axis along the edge.
    axis: u32,
    // The laws of both walls, from the velocity along the edge.
    first: Friction,
    second: Friction,
    share: f32,
}

fn edge_at(n: u32, blocked: bool) -> Edge {
    let first = wall_cells[2u * n];
    let second = wall_cells[2u * n + 1u];
    let axis = 3u - first.face / 2u - second.face / 2u;
    let along = vec2(velocity_above(first)[axis], velocity_above(second)[axis]);
    let laws = array(friction_at(first, vec2(along.x, 0.0), blocked), friction_at(second, vec2(along.y, 0.0), blocked));
    return Edge(axis, laws[0], laws[1], min(laws[0].share, laws[1].share));
}

fn set_near_edge(n: u32, edge: Edge) {
    var law = edge.first;
    law.share = edge.share;
    set_near_wall(wall_cells[2u * n], law);
}

// As near_wall.
@compute @workgroup_size(64)
fn near_edges(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (2u * n < arrayLength(&wall_cells)) {
        set_near_edge(n, edge_at(n, false));
    }
}

// Sum of w c c over the links of an edge, c along it, times 6.
const EDGE_SUM = 11.0 / 18.0;

@compute @workgroup_size(64)
fn wall_edges(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    let count = arrayLength(&wall_cells) / 2u;
    if (n >= count) {
        return;
    }
    let edge = edge_at(n, has_block(2u * n) || has_block(2u * n + 1u));
    set_near_edge(n, edge);
    var f: array<f32, 10>;
    var arriving = 0.0;
    for (var j = 0u; j < 10u; j++) { // unroll
        f[j] = read_arrived(wall_links[j * count + n]);
        arriving += select(-f[j], f[j], j % 2u == 1u);
    }
    arriving -= 0.25 * EDGE_SUM * balanced_force(padded_cell(wall_cells[2u * n].cell))[edge.axis];
    let stress = vec2(sign(edge.first.velocity.x) * edge.first.stress, sign(edge.second.velocity.x) * edge.second.stress);
    // Limits m to twice the larger velocity that the laws have read.
    let most = 2.0 * max(edge.first.speed, edge.second.speed);
    let momentum = edge.share * clamp((2.0 * arriving - stress.x - stress.y) / EDGE_SUM, -most, most);
    for (var j = 0u; j < 10u; j++) { // unroll
        let back = select(6.0 / 216.0, 6.0 / 54.0, j < 4u) * momentum;
        write_returned(wall_links[j * count + n], f[j] - select(-back, back, j % 2u == 1u));
    }
    // What both walls receive, by the stress of the laws.
    let received = 2.0 * arriving - EDGE_SUM * momentum;
    let laws = edge.first.stress + edge.second.stress;
    let part = select(0.5, edge.first.stress / laws, laws > 0.0);
    wall_stress[2u * n] = WallStress(along_edge(n * 2u, edge.axis, part * received), edge.first.friction, edge.share);
    wall_stress[2u * n + 1u] = WallStress(along_edge(n * 2u + 1u, edge.axis, (1.0 - part) * received), edge.second.friction, edge.share);
}

// A stress along an edge, along the lower and the upper axis of a face.
fn along_edge(n: u32, axis: u32, stress: f32) -> vec2<f32> {
    return along_wall(select(vec3(0.0), vec3(stress), vec3(0u, 1u, 2u) == vec3(axis)), wall_cells[n].face / 2u);
}
