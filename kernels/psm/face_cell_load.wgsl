// Batchelor 1967, eq. 3.3.11 at a wall: the traction t = -p n + nu du/dn of the fluid on one face of a part, from a
// layer of cells along it; the tangential velocity is linear between the face and a cell's centre. Forces
// inside the solid belong to no face: full cells reflect the populations that they contained when they were covered.
// needs solid_cell, psm_planes, face_layer, face_siblings

// Viscosity of the fluid, lattice units.
override VISCOSITY: f32;

struct FaceJob {
    tile: u32,
    // Index of the face in its part.
    face: u32,
    // Layer of cells along the face: 0, or 1 for the one over it.
    layer: u32,
}

@group(0) @binding(4) var<storage, read> jobs: array<FaceJob>;
@group(0) @binding(5) var<storage, read> parts: array<Part>;
// FACE_LOAD numbers per job, sums over the cells: traction (3), its moment about the block's centroid (3), height, foot on
// the face from the centroid (3) and its products (xx, yy, zz, yz, zx, xy), cells with fluid, cells.
@group(0) @binding(7) var<storage, read_write> face_partials: array<f32>;

var<private> sums: array<f32, FACE_LOAD>;

fn add_layer_cell(job: FaceJob, tile: Tile, local: u32) {
    let part = parts[tile.part];
    let cell = tile.cell + vec3<i32>(place_in_brick(local));
    let layer = layer_cell(part, job.face, job.layer, centre_from(cell, part.base, part.fraction));
    if (!layer.here) {
        return;
    }
    let hidden = sibling_over_face(tile, cell, layer);
    if (hidden == SEAM) {
        return;
    }
    let at = local * LANES_OF_ELEMENT + tile.lane;
    // The cell may contain another block or a wall.
    let others = read_psm(PLANE_SUM, tile.slot, at);
    let fluid = others <= 0.0 && read_psm(PLANE_BETA, tile.slot, at) != 0.0;
    // The centre of a cell that another solid fills in part may be in the fluid: the cell has no pressure, but is wet.
    let mostly_open = others > 0.0 && decode_sum(others).fraction < 0.5;
    if (!fluid && (hidden == CUT || mostly_open)) {
        return;
    }
    sums[FACE_LOAD - 1u] += 1.0;
    if (!fluid) {
        return;
    }
    let motion = motions[tile.block];
    let foot = centre_from(cell, motion.base, motion.fraction) - layer.height * layer.normal;
    let u = vec3(
        read_psm(PLANE_G, tile.slot, at),
        read_psm(PLANE_G + 1u, tile.slot, at),
        read_psm(PLANE_G + 2u, tile.slot, at),
    ) - velocity_at(motion, foot);
    let along = u - dot(u, layer.normal) * layer.normal;
    let p = read_psm(PLANE_A, tile.slot, at) / 3.0;
    let traction = VISCOSITY / layer.height * along - p * layer.normal;
    let moment = cross(foot, traction);
    for (var i = 0u; i < 3u; i++) { // unroll
        sums[i] += traction[i];
        sums[3u + i] += moment[i];
        sums[7u + i] += foot[i];
        sums[10u + i] += foot[i] * foot[i];
        sums[13u + i] += foot[(i + 1u) % 3u] * foot[(i + 2u) % 3u];
    }
    sums[6] += layer.height;
    sums[FACE_LOAD - 2u] += 1.0;
}

// Adds every `stride`-th cell of a job, starting at `local`. Only cells that the part can reach may be in a layer.
fn add_layer(job: FaceJob, local: u32, stride: u32) {
    let tile = tiles[job.tile];
    let reach = reach_of(tile.inside);
    for (var l = reach.x + local; l < reach.y; l += stride) {
        let mark = solid_fractions[job.tile * WORKGROUP + l];
        let apart = job.layer > 0u && mark == 0.0 && in_domain(place_in_brick(l), tile.inside);
        if (mark < 0.0 || apart) {
            add_layer_cell(job, tile, l);
        }
    }
}
