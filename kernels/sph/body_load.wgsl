// Gardner & Sitar 2018, eqs. 11-12, for particles: the load on each body from the forces on its boundary particles. These act inside
// the surface and are weak along edges, so the strains of deformable bodies follow from the pressures on their faces.
// needs bodies, clock, body_sums

@group(0) @binding(0) var<storage, read> reference_positions: array<ReferencePosition>;
@group(0) @binding(1) var<storage, read> motions: array<BodyMotion>;
@group(0) @binding(2) var<storage, read> forces: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> clock: Clock;
// Symmetric part of (area vector) (x) r of each boundary particle in its body, square spacings times spacings.
@group(0) @binding(5) var<storage, read> strain_areas: array<mat3x3<f32>>;

// Whether a body deforms.
override DEFORMS: bool;

// Sum over the pressures of an invocation.
var<private> strain: mat3x3<f32>;

@compute @workgroup_size(64)
fn body_load(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let body = group.x + group.y * groups.x;
    if (is_loaded(body) && clock.step != 0.0) {
        let motion = motions[body];
        let end = motion.first + motion.count;
        for (var n = motion.first + local; n < end; n += 64u) {
            let x = reference_positions[n].position;
            let rotated = clock.elapsed * (velocity_at(motion, x) - motion.velocity);
            add_force(forces[n].xyz, lever(motion, x) + rotated);
            if (DEFORMS) {
                let f = mat3x3(motion.deformation_x, motion.deformation_y, motion.deformation_z);
                strain -= forces[n].w * (f * strain_areas[n] * transpose(f));
            }
        }
    }
    if (DEFORMS) {
        replace_symmetric_part(strain);
    }
    reduce_load(body, local, clock.step);
}
