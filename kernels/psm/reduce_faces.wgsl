// Batchelor 1967, eq. 3.3.11 at a wall: the traction t = -p n + nu du/dn of the fluid on one face of a part, from the
// layer of cells beside it; the tangential velocity is linear between the face and a cell's centre. Inside the solid
// no force belongs to one face: full cells reflect what was in them when they were covered. A workgroup is a job.
// needs solid_cell, psm_planes, beside_face, beside_siblings

// Of the fluid, lattice units.
override VISCOSITY: f32;

struct FaceJob {
    tile: u32,
    // Number of the face in its part.
    face: u32,
}

@group(0) @binding(4) var<storage, read> jobs: array<FaceJob>;
@group(0) @binding(5) var<storage, read> parts: array<Part>;
// FACE_LOAD a job, sums over the cells: traction (3), its moment about the block's centroid (3), height, their feet on
// the face from there (3) and the products of these (xx, yy, zz, yz, zx, xy), cells with fluid, cells.
@group(0) @binding(7) var<storage, read_write> face_partials: array<f32>;

var<private> sums: array<f32, FACE_LOAD>;
var<workgroup> sums_of_all: array<f32, 64 * FACE_LOAD>;

fn add_beside(job: FaceJob, tile: Tile, local: u32) {
    let part = parts[tile.part];
    let cell = tile.cell + vec3<i32>(place_in_brick(local));
    let beside = beside_face(part, job.face, centre_from(cell, part.base, part.fraction));
    if (!beside.here) {
        return;
    }
    let hidden = beside_siblings(tile, cell, beside);
    if (hidden == SEAM) {
        return;
    }
    let first = plane_element(tile.slot, 0u, WORKGROUP, local) * LANES_OF_ELEMENT + tile.lane;
    let stride = WORKGROUP * LANES_OF_ELEMENT;
    // Another block may be in the cell, or a wall.
    let sum = decode_sum(saturation[first + PLANE_SUM * stride]);
    let fluid = sum.beside && saturation[first + PLANE_BETA * stride] != 0.0;
    if (!fluid && hidden == CUT) {
        return;
    }
    sums[FACE_LOAD - 1u] += 1.0;
    if (!fluid) {
        return;
    }
    let motion = motions[tile.block];
    let foot = centre_from(cell, motion.base, motion.fraction) - beside.height * beside.normal;
    let u = vec3(
        saturation[first + PLANE_G * stride],
        saturation[first + (PLANE_G + 1u) * stride],
        saturation[first + (PLANE_G + 2u) * stride],
    ) - velocity_at(motion, foot);
    let along = u - dot(u, beside.normal) * beside.normal;
    let p = saturation[first + PLANE_A * stride] / 3.0;
    let traction = VISCOSITY / beside.height * along - p * beside.normal;
    let moment = cross(foot, traction);
    for (var i = 0u; i < 3u; i++) { // unroll
        sums[i] += traction[i];
        sums[3u + i] += moment[i];
        sums[7u + i] += foot[i];
        sums[10u + i] += foot[i] * foot[i];
        sums[13u + i] += foot[(i + 1u) % 3u] * foot[(i + 2u) % 3u];
    }
    sums[6] += beside.height;
    sums[FACE_LOAD - 2u] += 1.0;
}

@compute @workgroup_size(64)
fn reduce_faces(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let turn = turn_of(group, groups);
    let here = turn < arrayLength(&jobs);
    if (here) {
        let job = jobs[turn];
        let tile = tiles[job.tile];
        for (var l = local; l < WORKGROUP; l += 64u) {
            if (shares[job.tile * WORKGROUP + l] < 0.0) {
                add_beside(job, tile, l);
            }
        }
    }
    for (var k = 0u; k < FACE_LOAD; k++) {
        sums_of_all[k * 64u + local] = sums[k];
    }
    workgroupBarrier();
    if (!here || local >= FACE_LOAD) {
        return;
    }
    var sum = 0.0;
    for (var n = 0u; n < 64u; n++) {
        sum += sums_of_all[local * 64u + n];
    }
    face_partials[turn * FACE_LOAD + local] = sum;
}
