// Gardner & Sitar 2018, eqs. 11-12, by faces: force, moment and wetted area of one face of a part in one tile. What a
// cell feels belongs to the face that is highest over it; deep cells belong to none. A workgroup is a job.
// needs solid_cell, face_planes

struct FaceJob {
    tile: u32,
    // Number of the face in its part.
    face: u32,
}

@group(0) @binding(4) var<storage, read> jobs: array<FaceJob>;
@group(0) @binding(5) var<storage, read> parts: array<Part>;
// FACE_LOAD a job: force (3), moment about the block's centroid (3), area in cells with fluid, cells.
@group(0) @binding(7) var<storage, read_write> face_partials: array<f32>;

var<workgroup> forces: array<vec4<f32>, 64>;
var<workgroup> moments: array<vec4<f32>, 64>;

@compute @workgroup_size(64)
fn reduce_faces(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let turn = turn_of(group, groups);
    let here = turn < min(TILES, arrayLength(&jobs));
    var force: vec4<f32>;
    var moment: vec4<f32>;
    if (here) {
        let job = jobs[turn];
        let tile = tiles[job.tile];
        let part = parts[tile.part];
        for (var l = local; l < WORKGROUP; l += 64u) {
            let share = shares[job.tile * WORKGROUP + l];
            if (share <= 0.0 || share == DEEP) {
                continue;
            }
            let cell = solid_cell(tile, share, l);
            let centre = centre_from(tile.cell + vec3<i32>(place_in_brick(l)), part.base, part.fraction);
            let face = face_in_cell(part, job.face, centre);
            force += vec4(select(vec3(0.0), cell.f, face.owns), select(0.0, face.area, cell.beta > 0.0));
            moment += vec4(select(vec3(0.0), cross(cell.r, cell.f), face.owns), select(0.0, 1.0, face.owns));
        }
    }
    forces[local] = force;
    moments[local] = moment;
    workgroupBarrier();
    if (!here || local >= FACE_LOAD) {
        return;
    }
    // Numbers 0-2 are the force, 3-5 the moment, then area and cells.
    let of_force = local < 3u || local == 6u;
    let component = select(select(local - 3u, 3u, local > 5u), local, local < 3u);
    var sum = 0.0;
    for (var n = 0u; n < 64u; n++) {
        sum += select(moments[n][component], forces[n][component], of_force);
    }
    face_partials[turn * FACE_LOAD + local] = sum;
}
