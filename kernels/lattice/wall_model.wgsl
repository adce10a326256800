// Asmuth, Janssen, Olivares-Espinosa & Ivanell 2021, Phys. Fluids 33:105111: the stress of a law of the wall, imposed through the
// velocity of the wall in half-way bounce-back. The populations return less 6 w c.m with m = 3 (2 P - stress), where P is the
// tangential momentum that arrives at the wall, so that the fluid loses the stress exactly. The law reads the velocity of the
// previous step in the fifth cell. Where the flow is laminar, m goes to 0 and the wall is bit-identical to a no-slip wall.
// needs wall_cells, scalars, link, cell_velocities, law_of_the_wall, mixing_length, $wall_blocks

struct WallStress {
    // Tangential stress on the wall, along the lower and the upper axis of the face.
    stress: vec2<f32>,
    // Friction velocity of the law, and share of the stress that follows from the law: 0 for no slip, 1 for the law alone.
    friction: f32,
    share: f32,
}

// Links into the wall, nine per cell: link j of all cells precedes link j + 1. The tangential direction of link j is j % 3 - 1
// along the lower and j / 3 - 1 along the upper axis of the face.
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
    let u = along_wall(scalar_of(layer_cell(here, SAMPLE)), here.face / 2u);
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

// The velocity along the lower and the upper axis of a face normal to an axis.
fn along_wall(at: u32, axis: u32) -> vec2<f32> {
    let u = vec3(read_velocity(0u, at), read_velocity(1u, at), read_velocity(2u, at));
    return select(select(u.xy, u.xz, axis == 1u), u.yz, axis == 0u);
}
